#include "pipeline/case/layer_keys.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

constexpr double least_growth = 1, most_growth = 2;
constexpr double most_layers = 1000;

LayerRule& layer_rule_of(std::deque<LayerRule>& rules, const std::string& name) {
  const auto known =
      std::find_if(rules.begin(), rules.end(), [&](const LayerRule& rule) { return rule.name == name; });
  LayerRule& rule = known != rules.end() ? *known : rules.emplace_back();
  rule.name = name;
  return rule;
}

void declare_layer_rule(KeyTable& keys, LayerRule& rule) {
  keys.number("first", rule.first, Range::above(0, length_unit),
              {"Height of the first layer on this patch.", "as for all walls", "2e-5"});
  keys.integer("constant", rule.constant, Range::between(1, most_layers, "layers"),
               {"As `layers.constant`, on this patch.", "as for all walls", "3"});
  keys.number("growth", rule.growth, Range::between(least_growth, most_growth),
              {"As `layers.growth`, on this patch.", "as for all walls", "1.3"});
  keys.integer("count", rule.count, Range::between(0, most_layers, "layers"),
               {"As `layers.count`, on this patch; 0: no layers.", "as for all walls", "0"});
  keys.number("total", rule.total, Range::above(0, length_unit),
              {"As `layers.total`, on this patch.", "as for all walls", "0.01"});
  using layers::InnerSides;
  keys.choice<InnerSides>(
      "side", rule.side,
      {{"none", InnerSides::none},
       {"front", InnerSides::front},
       {"back", InnerSides::back},
       {"both", InnerSides::both}},
      "The sides of inner faces that have layers. `front`: in the front region of a face "
      "between two regions, A of `interface_A_B`; on a baffle where the normal of its CAD "
      "surface points. Without the key inner faces have none.");
}

void declare_first(KeyTable& keys, LayerRequest& request) {
  keys.number_or("level", request.first_of_level, "first", request.first, Range::above(0, length_unit),
                 common({"Height of the layer at the wall. `level`: from the y+ of `sizing.level`, with "
                         "`reynolds` and `length`; these two alone mean the same.",
                         "from `y_plus`, `reynolds` and `length`", "1e-5"}));
  keys.number("y_plus", request.y_plus, Range::between(1e-3, 1000),
              {"Wall distance of the first node in units of the flow; with `sizing.solver: cell`, of the "
               "centre of the first cell. The height is 0.80 y+ L / (Re sqrt(cf / 2)) with cf = 0.026 / "
               "Re^(1/7), as on a flat plate.",
               "that of `sizing.level`", "1"});
  keys.number("reynolds", request.reynolds, Range::between(1, 1e12),
              {"Reynolds number of the flow over `length`.", "needed with `y_plus`", "5e6"});
  keys.number("length", request.length, Range::above(0, length_unit),
              {"Length to which `reynolds` refers.", "needed with `y_plus`", "7"});
}

void declare_stops(KeyTable& keys, LayerRequest& request) {
  keys.integer(
      "constant", request.constant, Range::between(1, most_layers, "layers"),
      {"Number of layers at the wall that are as high as the first.", "that of `sizing.level`, or 2", "2"});
  keys.number(
      "growth", request.growth, Range::between(least_growth, most_growth),
      common({"Ratio of the heights of successive layers. It is less where there is little room.",
              "that of `sizing.level`; with `count` and `total` the one by which they fit; or 1.2", "1.2"}));
  keys.number("growth_maximum", request.growth_maximum, Range::between(least_growth, most_growth),
              "Largest growth where it follows from `count` and `total`, or where `fit: growth` raises it.");
  keys.integer("count", request.count, Range::between(1, most_layers, "layers"),
               {"Largest number of layers.", "as many as `until` takes", "40"});
  keys.number("total", request.total, Range::above(0, length_unit),
              {"Largest height of all layers together.", "as high as `until` takes", "0.02"});
  keys.choice<LayerEnd>("until", request.until, {{"isotropic", LayerEnd::isotropic}},
                        "Where layers stop without `count` and `total`. `isotropic`: once the last is 0.7 "
                        "times as high as the triangles there are wide.");
  keys.choice<LayerFit>(
      "fit", request.fit,
      {{"none", LayerFit::none}, {"growth", LayerFit::growth}, {"count", LayerFit::count}},
      "What changes on a patch whose `count` or `total` ends layers, at its mean edge, before half of the "
      "height at which `until` ends them. `growth`: it is raised, at most to `growth_maximum`, so that "
      "`count` layers end there; `total` no longer holds, and without `count` it gives their number. "
      "`count`: neither `count` nor `total` holds.");
  using layers::LayerElements;
  keys.choice<LayerElements>("elements", request.elements,
                             {{"prisms", LayerElements::prisms}, {"tets", LayerElements::tets}},
                             "Cells of the layers. `prisms`: also pyramids and tetrahedra where neighbours "
                             "have different numbers of layers. `tets`: all of these cut into tetrahedra.");
  using layers::FanPlaces;
  keys.choice<FanPlaces>(
      "fans", request.fans, {{"none", FanPlaces::none}, {"all", FanPlaces::all}},
      "Where sharp edges have several columns with hexahedra between. `all`: everywhere; where such an edge "
      "ends on a wall layers step down to zero at this point.");
}

void declare_layer_gate(KeyTable& keys, LayerGate& gate) {
  keys.number("full_area", gate.full_area, Range::between(0, 1),
              {"Least part of the area of walls with layers that has all layers asked for.", "none", "0.95"});
}

/// The rule has a height, its own or that of all.
void check_layer_rule(const KeyTable& keys, const LayerRule& rule, bool height_for_all) {
  if (height_for_all || rule.first || rule.count == 0) return;
  const std::string path = "layers.patches." + rule.name;
  throw CaseError(fmt::format("{}: '{}' needs 'first', for 'layers' has no height of the first layer",
                              keys.where(path), path));
}

/// Where a member of a rule or of all walls was given; a rule's first.
std::string path_of_member(const char* member, const LayerRule* rule, bool is_of_rule) {
  return is_of_rule ? fmt::format("layers.patches.{}.{}", rule->name, member)
                    : fmt::format("layers.{}", member);
}

/// The heights ask for at least one layer and have an end.
void check_heights(const KeyTable& keys, const CaseDraft& draft, const LayerRule* rule) {
  const layers::WallLayers wanted = wanted_layers(draft.result.layers, draft.result.sizing, rule);
  if (wanted.first <= 0) return;
  const std::string patch = rule != nullptr ? fmt::format(" on patch '{}'", rule->name) : "";
  if (wanted.growth <= 1 && wanted.count == 0 && wanted.total == 0) {
    const std::string path = path_of_member("growth", rule, rule != nullptr && rule->growth);
    throw CaseError(
        fmt::format("{}: '{}' is {:g}, and neither 'count' nor 'total' ends the layers{}. Remedy: "
                    "one of the two, or a growth above 1",
                    keys.where(path), path, wanted.growth, patch));
  }
  if (wanted.total > 0 && wanted.total < wanted.first) {
    const std::string path = path_of_member("total", rule, rule != nullptr && rule->total);
    const std::string at = path_of_member("first", rule, rule != nullptr && rule->first);
    const std::string where = keys.where(rule != nullptr && rule->first && !rule->total ? at : path);
    throw CaseError(
        fmt::format("{}: '{}' is {:.6g}, less than the height of the first layer{}, {:.6g}: none "
                    "fits. Remedy: a larger 'total', or a lower 'first'",
                    where, path, wanted.total, patch, wanted.first));
  }
}

}  // namespace

void declare_layers(KeyTable& root, CaseDraft& draft) {
  LayerRequest& request = draft.result.layers;
  KeyTable& keys = root.section(
      "layers",
      common("Boundary layers: prisms on walls, for viscous flow ([how to make "
             "them](how_to_boundary_layers.md)). Layers are made only if the case has this section."),
      &request.given);
  keys.choice<LayeredWalls>(
      "walls", request.walls, {{"auto", LayeredWalls::all}, {"none", LayeredWalls::none}},
      "Which patches get layers. `auto`: all of type `wall`. `none`: those below `patches` alone.");
  declare_first(keys, request);
  declare_stops(keys, request);
  declare_layer_gate(
      keys.section(
          "gate",
          "Limits for the layers. If one is missed, the run ends with exit code 6 after writing the mesh.",
          &request.gate.given),
      request.gate);
  keys.named_sections(
      "patches", "Layers of single patches that differ from the others.",
      {"A patch of type `wall`, or one of inner faces with `side`, by its name.", "", "nacelle"},
      [&rules = draft.layer_rules](const std::string& name, KeyTable& table) {
        declare_layer_rule(table, layer_rule_of(rules, name));
      });
}

void check_layers(const KeyTable& keys, const CaseDraft& draft) {
  const LayerRequest& request = draft.result.layers;
  if (!request.given) return;
  const auto refuse = [&](const std::string& key, const std::string& text) {
    throw CaseError(fmt::format("{}: {}", keys.where(key), text));
  };
  const bool from_flow = request.y_plus || request.reynolds || request.length || request.first_of_level;
  if (request.first_of_level && request.y_plus)
    refuse("layers.first",
           "'layers.first: level' and 'layers.y_plus' exclude each other: y+ is that of the "
           "level, or it is given");
  if (request.first_of_level && !draft.result.sizing.level)
    refuse("layers.first", "'layers.first: level' needs 'sizing.level', which has a y+");
  if (request.first && from_flow) {
    const char* const other = request.y_plus ? "y_plus" : request.reynolds ? "reynolds" : "length";
    refuse("layers.first",
           fmt::format("'layers.first' and 'layers.{}' exclude each other: the height is given, or it comes "
                       "from the flow",
                       other));
  }
  if (from_flow && !(request.reynolds && request.length))
    refuse(request.first_of_level ? "layers.first"
           : request.y_plus       ? "layers.y_plus"
           : request.reynolds     ? "layers.reynolds"
                                  : "layers.length",
           "the height of the first layer comes from the flow: 'layers.reynolds' and 'layers.length' are "
           "needed, both");
  if (from_flow && !request.y_plus && !draft.result.sizing.level)
    refuse("layers.reynolds", "needs 'layers.y_plus', or 'sizing.level', which has one");
  const bool height_for_all = request.first || from_flow;
  const bool of_heights = request.constant || request.growth || request.count || request.total ||
                          request.gate.given || request.fit != LayerFit::none;
  if (request.walls == LayeredWalls::all && !height_for_all && (of_heights || !draft.layer_rules.empty()))
    refuse("layers",
           "'layers' needs the height of the first layer: 'first', or 'reynolds' and 'length' with 'y_plus'; "
           "or 'walls: none', and 'first' below 'patches'");
  if (request.walls == LayeredWalls::none && draft.layer_rules.empty())
    refuse("layers.walls", "with 'layers.walls: none' patches with layers are needed below 'layers.patches'");
  for (const LayerRule& rule : draft.layer_rules) check_layer_rule(keys, rule, height_for_all);
  if (request.walls == LayeredWalls::all) check_heights(keys, draft, nullptr);
  for (const LayerRule& rule : draft.layer_rules) check_heights(keys, draft, &rule);
}

}  // namespace aeroloom::cases
