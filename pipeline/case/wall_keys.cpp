#include "pipeline/case/wall_keys.hpp"

#include "pipeline/case/case_keys.hpp"
#include "sizing/sources/size_requests.hpp"
#include "sizing/sources/surface_request.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

/// The rule of that name, a new one where there is none.
template <class Rule>
Rule& rule_of(std::deque<Rule>& rules, const std::string& name) {
  const auto known =
      std::find_if(rules.begin(), rules.end(), [&](const Rule& rule) { return rule.name == name; });
  Rule& rule = known != rules.end() ? *known : rules.emplace_back();
  rule.name = name;
  return rule;
}

void declare_wall(WallRule& rule, KeyTable& keys) {
  keys.texts(
      "faces", rule.faces,
      {"Patterns of names of faces or patches (`*` any characters, `?` one).", "all walls", "['wing_*']"});
  keys.number("size", rule.size, Range::above(0, length_unit),
              {"Largest size of elements at these walls and up to `distance` from them. Only smaller sizes "
               "replace it.",
               "needed", "0.05"});
  keys.number(
      "distance", rule.distance, Range::between(0, std::numeric_limits<double>::infinity(), length_unit),
      {"Distance up to which the size holds; beyond it sizes grow by `sizing.growth`.", "needed", "0.5"});
}

void declare_edge(EdgeRule& rule, KeyTable& keys) {
  keys.texts("between", rule.between,
             {"Patterns of names of faces or patches: one for the edges of its faces, two for the edges "
              "common to both.",
              "all edges in the box", "['wing_*', 'fuselage*']"});
  keys.point("low", rule.low,
             {"A corner of a box: only parts of edges inside it count. A small box around a vertex gives a "
              "size to the vertex.",
              "no box; needs `between` then", "[0, 0, 0]"});
  keys.point("high", rule.high, {"The opposite corner.", "no box", "[1, 1, 1]"});
  keys.number("size", rule.size, Range::above(0, length_unit),
              {"Largest size of elements along these edges. Only smaller sizes replace it.",
               "needed, or `height`", "0.02"});
  keys.number(
      "height", rule.height, Range::above(0, length_unit),
      {"In place of `size`: rows of triangles on the faces beside these edges, the first of this height "
       "([Rows along edges](configuration/sizing.md#rows-along-edges)).",
       "no rows", "0.001"});
  keys.number("growth", rule.growth, Range::between(1.01, 2),
              {"Height of a row over that of the one before. Needs `height`.", "1.2", "1.2"});
  keys.number("stretch", rule.stretch, Range::between(1, 100),
              {"Length of triangles along these edges over `height`, at most. Needs `height`.", "2", "4"});
}

void require(const KeyTable& keys, const std::string& path, bool holds, const char* what) {
  if (!holds) throw CaseError(fmt::format("{}: '{}' {}", keys.where(path), path, what));
}

}  // namespace

void declare_walls(KeyTable& sizing, std::deque<WallRule>& rules) {
  sizing.named_sections(
      "walls",
      "Bands of small elements along walls ([Walls, wakes and "
      "edges](configuration/sizing.md#walls-wakes-and-edges)).",
      {"A band of a name that you choose.", "", "near_wing"},
      [&rules](const std::string& name, KeyTable& keys) { declare_wall(rule_of(rules, name), keys); });
}

void declare_edges(KeyTable& sizing, std::deque<EdgeRule>& rules) {
  sizing.named_sections(
      "edges",
      "Sizes along CAD edges ([Walls, wakes and edges](configuration/sizing.md#walls-wakes-and-edges)).",
      {"Edges of a name that you choose.", "", "wing_root"},
      [&rules](const std::string& name, KeyTable& keys) { declare_edge(rule_of(rules, name), keys); });
}

void check_walls(const KeyTable& keys, const std::deque<WallRule>& rules) {
  for (const WallRule& rule : rules) {
    const std::string path = "sizing.walls." + rule.name;
    require(keys, path, rule.size.has_value(), "needs 'size'");
    require(keys, path, rule.distance.has_value(), "needs 'distance'");
  }
}

void check_edges(const KeyTable& keys, const std::deque<EdgeRule>& rules) {
  for (const EdgeRule& rule : rules) {
    const std::string path = "sizing.edges." + rule.name;
    require(keys, path, rule.size.has_value() != rule.height.has_value(),
            "needs 'size' or 'height', and not both");
    require(keys, path, rule.height.has_value() || (!rule.growth && !rule.stretch),
            "has 'growth' or 'stretch' without 'height'");
    require(keys, path, !rule.height || !rule.low, "has 'height' and a box: rows lie along whole edges");
    require(keys, path, rule.low.has_value() == rule.high.has_value(),
            "needs both 'low' and 'high' of a box");
    require(keys, path, rule.low || !rule.between.empty(), "needs 'between', or 'low' and 'high'");
    require(keys, path, rule.between.size() <= 2, "has more than two patterns in 'between'");
  }
}

sizing::WallSize wall_of(const WallRule& rule) {
  return {rule.name, rule.faces, rule.size.value_or(0), rule.distance.value_or(0)};
}

sizing::EdgeSize edge_of(const EdgeRule& rule) {
  constexpr double usual_stretch = 2;
  sizing::EdgeSize asked{rule.name, rule.between, {}, rule.size.value_or(0)};
  if (rule.height) {
    asked.size = rule.stretch.value_or(usual_stretch) * *rule.height;
    asked.size_at_ends = *rule.height;
  }
  if (rule.low && rule.high) {
    asked.within.emplace();
    asked.within->add(*rule.low);
    asked.within->add(*rule.high);
  }
  return asked;
}

std::vector<surface::EdgeRows> rows_along_edges(const std::vector<EdgeRule>& rules, const cad::Model& model) {
  std::vector<surface::EdgeRows> rows;
  for (const EdgeRule& rule : rules) {
    if (!rule.height) continue;
    rows.resize(static_cast<std::size_t>(model.edge_count()));
    for (const cad::EdgeId e : sizing::edges_like(model, edge_of(rule))) {
      if (rows[e].height > 0 && rows[e].height <= *rule.height) continue;
      rows[e].height = *rule.height;
      rows[e].growth = rule.growth.value_or(rows[e].growth);
    }
  }
  return rows;
}

}  // namespace aeroloom::cases
