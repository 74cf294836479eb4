#include "case/source_keys.hpp"

#include "case/case_keys.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

/// What a shape is made from.
struct ShapeKeys {
  SourceShape shape;
  const char* name;
  std::vector<std::string_view> keys;
};

const std::array<ShapeKeys, 6>& shapes() {
  static const std::array<ShapeKeys, 6> all{
      {{SourceShape::point, "point", {"center"}},
       {SourceShape::line, "line", {"from", "to"}},
       {SourceShape::sphere, "sphere", {"center", "radius"}},
       {SourceShape::box, "box", {"low", "high"}},
       {SourceShape::cylinder, "cylinder", {"from", "to", "radius"}},
       {SourceShape::cone, "cone", {"from", "to", "radius", "end_radius"}}}};
  return all;
}

std::vector<std::pair<std::string_view, bool>> given_keys(const SourceRule& rule) {
  return {{"center", rule.center.has_value()},
          {"low", rule.low.has_value()},
          {"high", rule.high.has_value()},
          {"from", rule.from.has_value()},
          {"to", rule.to.has_value()},
          {"radius", rule.radius.has_value()},
          {"end_radius", rule.end_radius.has_value()}};
}

void declare_rule(SourceRule& rule, KeyTable& keys) {
  std::vector<std::pair<std::string, std::optional<SourceShape>>> names;
  for (const ShapeKeys& each : shapes()) names.emplace_back(each.name, each.shape);
  keys.choice(
      "shape", rule.shape, names,
      common({"Shape of the region. A `cylinder` has plane ends; a `cone` has another radius at its other "
              "end.",
              "needed", "box"}));
  keys.number(
      "size", rule.size, Range::above(0, length_unit),
      common({"Largest size of elements in the region. Away from it sizes grow by `sizing.growth`. No other "
              "bound holds there but smaller sizes.",
              "needed", "0.05"}));
  const auto point = [&](const char* name, std::optional<geometry::Vec3>& target, const char* text,
                         const char* left_out) {
    keys.point(name, target, {text, left_out, "[0, 0, 0]"});
  };
  point("center", rule.center, "Centre of the region.", "needed by `point` and `sphere`, others have none");
  point("low", rule.low, "A corner of the box.", "needed by `box`, others have none");
  point("high", rule.high, "The opposite corner.", "needed by `box`, others have none");
  const char* with_axis = "needed by `line`, `cylinder` and `cone`, others have none";
  point("from", rule.from, "One end of the axis.", with_axis);
  point("to", rule.to, "The other end.", with_axis);
  keys.number(
      "radius", rule.radius, Range::above(0, length_unit),
      {"Radius; of a cone at `from`.", "needed by `sphere`, `cylinder` and `cone`, others have none", "0.5"});
  keys.number("end_radius", rule.end_radius, Range::above(0, length_unit),
              {"Radius of the cone at `to`.", "needed by `cone`, others have none", "1"});
}

}  // namespace

void declare_sources(KeyTable& sizing, std::deque<SourceRule>& rules) {
  sizing.named_sections("sources",
                        common("Regions with small elements: wakes, places behind a flap, the way of a shock "
                               "([Sources](configuration.md#sources))."),
                        common({"A region, of a name that you choose.", "", "wake"}),
                        [&rules](const std::string& name, KeyTable& keys) {
                          const auto known =
                              std::find_if(rules.begin(), rules.end(),
                                           [&](const SourceRule& rule) { return rule.name == name; });
                          SourceRule& rule = known != rules.end() ? *known : rules.emplace_back();
                          rule.name = name;
                          declare_rule(rule, keys);
                        });
}

void check_sources(const KeyTable& keys, const std::deque<SourceRule>& rules) {
  for (const SourceRule& rule : rules) {
    const std::string path = "sizing.sources." + rule.name;
    const auto refuse = [&](const std::string& what, const std::string& text) {
      throw CaseError(fmt::format("{}: '{}'{} {}", keys.where(path), path, what, text));
    };
    if (!rule.shape) refuse("", "needs 'shape'");
    const auto shape = std::find_if(shapes().begin(), shapes().end(),
                                    [&](const ShapeKeys& each) { return each.shape == rule.shape; });
    const std::string is = fmt::format(" is a {}: it", shape->name);
    for (const auto& [key, given] : given_keys(rule)) {
      const bool needed = std::find(shape->keys.begin(), shape->keys.end(), key) != shape->keys.end();
      if (needed && !given) refuse(is, fmt::format("needs '{}'", key));
      if (given && !needed) refuse(is, fmt::format("has no '{}'", key));
    }
    if (!rule.size) refuse(is, "needs 'size'");
  }
}

sizing::SizeRegion region_of(const SourceRule& rule) {
  using Shape = sizing::SizeRegion::Shape;
  sizing::SizeRegion region;
  region.name = rule.name;
  region.size = rule.size.value_or(0);
  switch (rule.shape.value_or(SourceShape::point)) {
    case SourceShape::box:
      region.shape = Shape::box;
      region.start = *rule.low, region.end = *rule.high;
      break;
    case SourceShape::point:
    case SourceShape::sphere:
      region.shape = Shape::sphere;
      region.start = region.end = rule.center.value_or(geometry::Vec3{});
      region.start_radius = rule.radius.value_or(0);
      break;
    case SourceShape::line:
    case SourceShape::cylinder:
    case SourceShape::cone:
      region.shape = Shape::cylinder;
      region.start = *rule.from, region.end = *rule.to;
      region.start_radius = rule.radius.value_or(0);
      region.end_radius = rule.end_radius.value_or(region.start_radius);
      break;
  }
  return region;
}

}  // namespace aeroloom::cases
