#include "pipeline/case/source_keys.hpp"

#include "pipeline/case/case_keys.hpp"
#include "sizing/sources/size_expression.hpp"
#include "sizing/sources/size_requests.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

/// Whether a shape has such a value always, so that its key must be given.
template <class Value>
constexpr bool is_needed = std::is_same_v<Value, double> || std::is_same_v<Value, geometry::Vec3>;

/// A key of a shape, and what it sets there.
template <class Shape, class Value>
struct ShapeKey {
  const char* name;
  Value Shape::*value;
};

/// The name of a shape and its keys.
template <class Shape>
struct ShapeKeys;

template <>
struct ShapeKeys<sizing::PointShape> {
  static constexpr const char* name = "point";
  static constexpr std::tuple keys{ShapeKey{"center", &sizing::PointShape::center}};
};

template <>
struct ShapeKeys<sizing::LineShape> {
  static constexpr const char* name = "line";
  static constexpr std::tuple keys{ShapeKey{"from", &sizing::LineShape::from},
                                   ShapeKey{"to", &sizing::LineShape::to}};
};

template <>
struct ShapeKeys<sizing::SphereShape> {
  static constexpr const char* name = "sphere";
  static constexpr std::tuple keys{ShapeKey{"center", &sizing::SphereShape::center},
                                   ShapeKey{"radius", &sizing::SphereShape::radius}};
};

template <>
struct ShapeKeys<sizing::BoxShape> {
  static constexpr const char* name = "box";
  static constexpr std::tuple keys{ShapeKey{"low", &sizing::BoxShape::low},
                                   ShapeKey{"high", &sizing::BoxShape::high}};
};

template <>
struct ShapeKeys<sizing::CylinderShape> {
  static constexpr const char* name = "cylinder";
  static constexpr std::tuple keys{ShapeKey{"from", &sizing::CylinderShape::from},
                                   ShapeKey{"to", &sizing::CylinderShape::to},
                                   ShapeKey{"radius", &sizing::CylinderShape::radius}};
};

template <>
struct ShapeKeys<sizing::ConeShape> {
  static constexpr const char* name = "cone";
  static constexpr std::tuple keys{
      ShapeKey{"from", &sizing::ConeShape::from}, ShapeKey{"to", &sizing::ConeShape::to},
      ShapeKey{"radius", &sizing::ConeShape::radius}, ShapeKey{"end_radius", &sizing::ConeShape::end_radius}};
};

template <>
struct ShapeKeys<sizing::WakeShape> {
  static constexpr const char* name = "wake";
  static constexpr std::tuple keys{
      ShapeKey{"from", &sizing::WakeShape::from},     ShapeKey{"to", &sizing::WakeShape::to},
      ShapeKey{"behind", &sizing::WakeShape::behind}, ShapeKey{"direction", &sizing::WakeShape::direction},
      ShapeKey{"length", &sizing::WakeShape::length}, ShapeKey{"end_size", &sizing::WakeShape::end_size}};
};

/// The keys of all shapes, in the order in which messages ask for them.
constexpr std::array<std::string_view, 11> shape_keys{"center",   "low",    "high",      "from",
                                                      "to",       "behind", "direction", "length",
                                                      "end_size", "radius", "end_radius"};

/// The values of a draft among which those of a key are.
template <class Value, class Draft>
auto& values_like(Draft& draft) {
  using Single = std::conditional_t<is_needed<Value>, std::optional<Value>, Value>;
  if constexpr (std::is_same_v<Single, std::optional<geometry::Vec3>>) {
    return draft.points;
  } else if constexpr (std::is_same_v<Single, std::optional<double>>) {
    return draft.lengths;
  } else {
    static_assert(std::is_same_v<Single, std::vector<std::string>>);
    return draft.patterns;
  }
}

template <class Shape>
sizing::SizeShape shape_of(const SourceDraft& source) {
  Shape shape;
  const auto take = [&]<class Value>(const ShapeKey<Shape, Value>& key) {
    const auto& given = values_like<Value>(source).at(key.name);
    if constexpr (is_needed<Value>) {
      shape.*key.value = given.value();
    } else {
      shape.*key.value = given;
    }
  };
  std::apply([&](const auto&... key) { (take(key), ...); }, ShapeKeys<Shape>::keys);
  return shape;
}

/// What a source of a shape is made from, and how.
struct ShapeRow {
  std::string_view name;
  std::vector<std::string_view> needed, optional;
  sizing::SizeShape (*make)(const SourceDraft&);
};

template <class Shape, class... Values>
constexpr bool sets_all(const std::tuple<ShapeKey<Shape, Values>...>& /*keys*/) {
  return (sizeof(Values) + ...) == sizeof(Shape);
}

constexpr bool is_shape_key(std::string_view name) {
  return std::find(shape_keys.begin(), shape_keys.end(), name) != shape_keys.end();
}

template <class Shape>
ShapeRow row_of() {
  static_assert(sets_all(ShapeKeys<Shape>::keys), "a value of the shape has no key");
  static_assert(
      std::apply([](const auto&... key) { return (is_shape_key(key.name) && ...); }, ShapeKeys<Shape>::keys),
      "a key of the shape is not among shape_keys");
  ShapeRow row{ShapeKeys<Shape>::name, {}, {}, shape_of<Shape>};
  const auto add = [&]<class Value>(const ShapeKey<Shape, Value>& key) {
    (is_needed<Value> ? row.needed : row.optional).emplace_back(key.name);
  };
  std::apply([&](const auto&... key) { (add(key), ...); }, ShapeKeys<Shape>::keys);
  return row;
}

template <class... Shapes>
std::vector<ShapeRow> rows_of(std::type_identity<std::variant<Shapes...>> /*shapes*/) {
  return {row_of<Shapes>()...};
}

/// In the order of the variant.
const std::vector<ShapeRow>& shape_rows() {
  static const std::vector<ShapeRow> rows = rows_of(std::type_identity<sizing::SizeShape>{});
  return rows;
}

bool is_given(const SourceDraft& source, std::string_view name) {
  const std::string key(name);
  const auto point = source.points.find(key);
  const auto length = source.lengths.find(key);
  const auto patterns = source.patterns.find(key);
  return (point != source.points.end() && point->second) ||
         (length != source.lengths.end() && length->second) ||
         (patterns != source.patterns.end() && !patterns->second.empty());
}

bool contains(const std::vector<std::string_view>& keys, std::string_view key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

void declare_wake(SourceDraft& source, KeyTable& keys) {
  keys.texts(
      "behind", source.patterns["behind"],
      {"Patterns of names of faces or patches: the wake begins at their trailing edges, sharp or blunt.",
       "a `wake` begins at the line from `from` to `to`, others have none", "['wing_*']"});
  keys.point("direction", source.points["direction"],
             {"Direction of the wake, of any length.", "needed by `wake`, others have none", "[1, 0, 0.05]"});
  keys.number("length", source.lengths["length"], Range::above(0, length_unit),
              {"Length of the wake.", "needed by `wake`, others have none", "10"});
  keys.number("end_size", source.lengths["end_size"], Range::above(0, length_unit),
              {"Largest size at the end of the wake; sizes change linearly along it.",
               "as `size`; shapes other than `wake` have none", "0.4"});
}

void declare_source(SourceDraft& source, KeyTable& keys) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const ShapeRow& row : shape_rows()) names.emplace_back(row.name, row.name);
  keys.choice("shape", source.shape, names,
              common({"Shape of the region. A `cylinder` has plane ends; a `cone` has a second radius at "
                      "`to`; a `wake` is the sheet that a line leaves behind.",
                      "needed", "box"}));
  keys.number("size", source.size, Range::above(0, length_unit),
              common({"Largest size of elements in the region. Beyond it sizes grow by `sizing.growth`. Only "
                      "smaller sizes replace it.",
                      "needed", "0.05"}));
  const auto point = [&](const char* name, const char* text, const char* left_out) {
    keys.point(name, source.points[name], {text, left_out, "[0, 0, 0]"});
  };
  point("center", "Centre of the region.", "needed by `point` and `sphere`, others have none");
  point("low", "A corner of the box.", "needed by `box`, others have none");
  point("high", "The opposite corner.", "needed by `box`, others have none");
  const char* with_axis = "needed by `line`, `cylinder`, `cone` and `wake` (or `behind`), others have none";
  point("from", "One end of the axis, or of the line where a wake begins.", with_axis);
  point("to", "The other end.", with_axis);
  keys.number(
      "radius", source.lengths["radius"], Range::above(0, length_unit),
      {"Radius; of a cone at `from`.", "needed by `sphere`, `cylinder` and `cone`, others have none", "0.5"});
  keys.number("end_radius", source.lengths["end_radius"], Range::above(0, length_unit),
              {"Radius of the cone at `to`.", "needed by `cone`, others have none", "1"});
  declare_wake(source, keys);
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

void declare_sources(KeyTable& sizing, std::deque<SourceDraft>& sources) {
  sizing.named_sections(
      "sources",
      common("Regions with small elements, such as wakes ([Sources](configuration/sizing.md#sources))."),
      common({"A region of a name that you choose.", "", "wake"}),
      [&sources](const std::string& name, KeyTable& keys) {
        const auto known = std::find_if(sources.begin(), sources.end(),
                                        [&](const SourceDraft& source) { return source.name == name; });
        SourceDraft& source = known != sources.end() ? *known : sources.emplace_back();
        source.name = name;
        declare_source(source, keys);
      });
}

namespace {

const ShapeRow& row_like(const SourceDraft& source) {
  return *std::find_if(shape_rows().begin(), shape_rows().end(),
                       [&](const ShapeRow& row) { return row.name == source.shape; });
}

/// What a wake is wrong about beside its keys; empty: nothing.
std::string fault_of_wake(const SourceDraft& source) {
  const bool from = is_given(source, "from"), to = is_given(source, "to");
  if (is_given(source, "behind") == (from && to) || from != to)
    return "needs either 'from' and 'to' or 'behind'";
  const std::optional<geometry::Vec3>& direction = source.points.at("direction");
  return direction && norm(*direction) > 0 ? "" : "needs a 'direction' that is not zero";
}

}  // namespace

void check_sources(const KeyTable& keys, const std::deque<SourceDraft>& sources) {
  for (const SourceDraft& source : sources) {
    const std::string path = "sizing.sources." + source.name;
    const auto refuse = [&](const std::string& what, const std::string& text) {
      throw CaseError(fmt::format("{}: '{}'{} {}", keys.where(path), path, what, text));
    };
    if (source.shape.empty()) refuse("", "needs 'shape'");
    const ShapeRow& row = row_like(source);
    const std::string is = fmt::format(" is a {}: it", row.name);
    for (const std::string_view key : shape_keys) {
      const bool needed = contains(row.needed, key), given = is_given(source, key);
      if (needed && !given) refuse(is, fmt::format("needs '{}'", key));
      if (given && !needed && !contains(row.optional, key)) refuse(is, fmt::format("has no '{}'", key));
    }
    if (!source.size) refuse(is, "needs 'size'");
    if (source.shape != ShapeKeys<sizing::WakeShape>::name) continue;
    const std::string fault = fault_of_wake(source);
    if (!fault.empty()) refuse(is, fault);
  }
}

std::vector<SourceRule> rules_of(const std::deque<SourceDraft>& sources) {
  std::vector<SourceRule> rules;
  for (const SourceDraft& source : sources)
    rules.push_back({source.name, row_like(source).make(source), source.size.value()});
  return rules;
}

std::deque<SourceDraft> drafts_of(const std::vector<SourceRule>& rules) {
  std::deque<SourceDraft> sources;
  for (const SourceRule& rule : rules) {
    SourceDraft& source = sources.emplace_back();
    source.name = rule.name;
    source.size = rule.size;
    const auto give = [&]<class Shape>(const Shape& shape) {
      source.shape = ShapeKeys<Shape>::name;
      const auto set = [&]<class Value>(const ShapeKey<Shape, Value>& key) {
        values_like<Value>(source)[key.name] = shape.*key.value;
      };
      std::apply([&](const auto&... key) { (set(key), ...); }, ShapeKeys<Shape>::keys);
    };
    std::visit(give, rule.shape);
  }
  return sources;
}

}  // namespace aeroloom::cases
