#include "pipeline/case/source_keys.hpp"

#include "pipeline/case/case_keys.hpp"
#include "sizing/sources/size_demands.hpp"
#include "sizing/sources/size_expression.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
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
  std::vector<std::string_view> optional = {};
};

const std::array<ShapeKeys, 7>& shapes() {
  static const std::array<ShapeKeys, 7> all{
      {{SourceShape::point, "point", {"center"}},
       {SourceShape::line, "line", {"from", "to"}},
       {SourceShape::sphere, "sphere", {"center", "radius"}},
       {SourceShape::box, "box", {"low", "high"}},
       {SourceShape::cylinder, "cylinder", {"from", "to", "radius"}},
       {SourceShape::cone, "cone", {"from", "to", "radius", "end_radius"}},
       {SourceShape::wake, "wake", {"direction", "length"}, {"from", "to", "behind", "end_size"}}}};
  return all;
}

std::vector<std::pair<std::string_view, bool>> given_keys(const SourceRule& rule) {
  return {{"center", rule.center.has_value()},
          {"low", rule.low.has_value()},
          {"high", rule.high.has_value()},
          {"from", rule.from.has_value()},
          {"to", rule.to.has_value()},
          {"behind", !rule.behind.empty()},
          {"direction", rule.direction.has_value()},
          {"length", rule.length.has_value()},
          {"end_size", rule.end_size.has_value()},
          {"radius", rule.radius.has_value()},
          {"end_radius", rule.end_radius.has_value()}};
}

void declare_wake(SourceRule& rule, KeyTable& keys) {
  keys.texts(
      "behind", rule.behind,
      {"Patterns of names of faces or patches: the wake begins at their trailing edges, sharp or blunt.",
       "a `wake` begins at the line from `from` to `to`, others have none", "['wing_*']"});
  keys.point("direction", rule.direction,
             {"Direction of the wake, of any length.", "needed by `wake`, others have none", "[1, 0, 0.05]"});
  keys.number("length", rule.length, Range::above(0, length_unit),
              {"Length of the wake.", "needed by `wake`, others have none", "10"});
  keys.number("end_size", rule.end_size, Range::above(0, length_unit),
              {"Largest size at the end of the wake; sizes change linearly along it.",
               "as `size`; shapes other than `wake` have none", "0.4"});
}

void declare_source_rule(SourceRule& rule, KeyTable& keys) {
  std::vector<std::pair<std::string, std::optional<SourceShape>>> names;
  for (const ShapeKeys& each : shapes()) names.emplace_back(each.name, each.shape);
  keys.choice("shape", rule.shape, names,
              common({"Shape of the region. A `cylinder` has plane ends; a `cone` has a second radius at "
                      "`to`; a `wake` is the sheet that a line leaves behind.",
                      "needed", "box"}));
  keys.number("size", rule.size, Range::above(0, length_unit),
              common({"Largest size of elements in the region. Beyond it sizes grow by `sizing.growth`. Only "
                      "smaller sizes replace it.",
                      "needed", "0.05"}));
  const auto point = [&](const char* name, std::optional<geometry::Vec3>& target, const char* text,
                         const char* left_out) {
    keys.point(name, target, {text, left_out, "[0, 0, 0]"});
  };
  point("center", rule.center, "Centre of the region.", "needed by `point` and `sphere`, others have none");
  point("low", rule.low, "A corner of the box.", "needed by `box`, others have none");
  point("high", rule.high, "The opposite corner.", "needed by `box`, others have none");
  const char* with_axis = "needed by `line`, `cylinder`, `cone` and `wake` (or `behind`), others have none";
  point("from", rule.from, "One end of the axis, or of the line where a wake begins.", with_axis);
  point("to", rule.to, "The other end.", with_axis);
  keys.number(
      "radius", rule.radius, Range::above(0, length_unit),
      {"Radius; of a cone at `from`.", "needed by `sphere`, `cylinder` and `cone`, others have none", "0.5"});
  keys.number("end_radius", rule.end_radius, Range::above(0, length_unit),
              {"Radius of the cone at `to`.", "needed by `cone`, others have none", "1"});
  declare_wake(rule, keys);
}

}  // namespace

void declare_reference_length(KeyTable& sizing, std::optional<double>& length) {
  sizing.number("reference_length", length, Range::above(0, length_unit),
                {"Unit of all sizes, lengths and places below `sizing`, of `groups.NAME.size` and of "
                 "`patches.NAME.size`, such as the mean chord ([Reference "
                 "length](configuration/sizing.md#reference-length)).",
                 "the length unit of the geometry", "4.2"});
}

void declare_expression(KeyTable& sizing, std::string& expression) {
  sizing.text("expression", expression,
              {"Largest size as a formula of `x`, `y` and `z`, all in the length unit of the geometry or in "
               "reference lengths ([Expression](configuration/sizing.md#expression)). At least `minimum`, if "
               "that is given.",
               "none", "max(0.05, 0.1*sqrt(x^2 + y^2 + z^2))"});
}

void check_expression(const KeyTable& keys, const std::string& expression) {
  if (expression.empty()) return;
  try {
    const sizing::SizeExpression parsed(expression);
  } catch (const std::invalid_argument& error) {
    throw CaseError(
        fmt::format("{}: 'sizing.expression': {}", keys.where("sizing.expression"), error.what()));
  }
}

void declare_sources(KeyTable& sizing, std::deque<SourceRule>& rules) {
  sizing.named_sections(
      "sources",
      common("Regions with small elements, such as wakes ([Sources](configuration/sizing.md#sources))."),
      common({"A region of a name that you choose.", "", "wake"}),
      [&rules](const std::string& name, KeyTable& keys) {
        const auto known = std::find_if(rules.begin(), rules.end(),
                                        [&](const SourceRule& rule) { return rule.name == name; });
        SourceRule& rule = known != rules.end() ? *known : rules.emplace_back();
        rule.name = name;
        declare_source_rule(rule, keys);
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
      const bool may =
          std::find(shape->optional.begin(), shape->optional.end(), key) != shape->optional.end();
      if (given && !needed && !may) refuse(is, fmt::format("has no '{}'", key));
    }
    if (!rule.size) refuse(is, "needs 'size'");
    if (rule.shape != SourceShape::wake) continue;
    if (rule.behind.empty() != (rule.from && rule.to) || rule.from.has_value() != rule.to.has_value())
      refuse(is, "needs either 'from' and 'to' or 'behind'");
    if (!(norm(*rule.direction) > 0)) refuse(is, "needs a 'direction' that is not zero");
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
    case SourceShape::wake:
      region.shape = Shape::cylinder;
      region.start = *rule.from, region.end = *rule.to;
      region.start_radius = rule.radius.value_or(0);
      region.end_radius = rule.end_radius.value_or(region.start_radius);
      break;
  }
  return region;
}

sizing::WakeSize wake_of(const SourceRule& rule) {
  const geometry::Vec3 nowhere;
  return {rule.name,
          rule.behind,
          rule.from.value_or(nowhere),
          rule.to.value_or(nowhere),
          normalized(rule.direction.value_or(nowhere)),
          rule.length.value_or(0),
          rule.size.value_or(0),
          rule.end_size.value_or(rule.size.value_or(0))};
}

}  // namespace aeroloom::cases
