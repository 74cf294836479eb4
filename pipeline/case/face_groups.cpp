#include "pipeline/case/face_groups.hpp"

#include "cad/model/patches.hpp"
#include "pipeline/case/face_finder.hpp"
#include "pipeline/case/face_texts.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

/// What each condition of a rule finds by itself, for the message about a rule that finds nothing.
std::string describe_found(const std::vector<FoundFaces>& found) {
  std::string text;
  for (const FoundFaces& each : found)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", each.what,
                        std::count(each.faces.begin(), each.faces.end(), 1));
  return text;
}

}  // namespace

bool FaceConditions::empty() const {
  return faces.empty() && parts.empty() && layers.empty() && colors.empty() && ids.empty() &&
         adjacent_to.empty() && !box && !normal && !area;
}

std::string origin_of(const GroupRule& rule) {
  return fmt::format("{}'groups.{}'", rule.where.empty() ? "" : rule.where + ": ", rule.name);
}

void check_conditions(const FaceConditions& c, const std::string& path) {
  const auto refuse = [&](const char* key, const std::string& text) {
    throw std::invalid_argument(fmt::format("'{}.{}': {}", path, key, text));
  };
  for (const auto& [key, patterns] : {std::pair("faces", &c.faces),
                                      {"part", &c.parts},
                                      {"layer", &c.layers},
                                      {"adjacent_to", &c.adjacent_to}}) {
    for (const std::string& pattern : *patterns) {
      try {
        const cad::NamePattern known(pattern);
      } catch (const std::invalid_argument& error) {
        refuse(key, error.what());
      }
    }
  }
  for (const std::string& color : c.colors)
    if (!plain_color(color))
      refuse("color", fmt::format("expected a colour such as '#ff0000', got '{}'", color));
  for (const std::string& id : c.ids)
    if (!number_range(id))
      refuse("ids", fmt::format("expected a number or a range such as 17-20, got '{}'", id));
  if (c.normal && norm(*c.normal) == 0) refuse("normal", "is zero and has no direction");
  if (c.within && !c.normal) refuse("within", "needs 'normal'");
}

std::vector<std::int32_t> find_groups(const cad::Model& model, const std::vector<GroupRule>& rules) {
  FaceFinder finder(model, rules);
  std::vector<std::int32_t> group_of_face(static_cast<std::size_t>(model.face_count()), no_group);
  for (std::size_t r = 0; r < rules.size(); ++r) {
    const std::vector<char>& selected = finder.faces_of(r);
    std::size_t all = 0, taken = 0;
    for (std::size_t f = 0; f < selected.size(); ++f) {
      if (!selected[f]) continue;
      ++all;
      if (group_of_face[f] == no_group)
        group_of_face[f] = static_cast<std::int32_t>(r);
      else
        ++taken;
    }
    if (rules[r].optional || taken < all) continue;
    if (all > 0)
      throw std::invalid_argument(
          fmt::format("{}: all faces that it selects ({}) belong to groups before it. Remedy: put it first",
                      origin_of(rules[r]), all));
    throw std::invalid_argument(fmt::format(
        "{}: no face meets all that it asks for; of {} faces: {}. Remedy: `aeroloom check` of the case "
        "without this group writes names, layers, colours, areas and boxes of all faces to check.json; "
        "`optional: true` where it may be empty",
        origin_of(rules[r]), selected.size(), describe_found(finder.explain(r))));
  }
  return group_of_face;
}

}  // namespace aeroloom::cases
