#include "pipeline/case/yaml_value.hpp"

#include "pipeline/case/case_error.hpp"
#include "pipeline/case/other_meshers.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace aeroloom::cases {

namespace {

std::optional<double> parse_number(const std::string& text) {
  const char* first = text.data() + (!text.empty() && text[0] == '+' ? 1 : 0);
  const char* last = text.data() + text.size();
  double value = 0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error != std::errc{} || end != last || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 60;
  std::string shown = text.substr(0, longest);
  while (shown.size() < text.size() && !shown.empty() && (text[shown.size()] & 0xC0) == 0x80)
    shown.pop_back();
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
  return shown.size() < text.size() ? shown + "..." : shown;
}

std::string describe(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return "'" + shortened(node.Scalar()) + "'";
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a map of keys";
    case YAML::NodeType::Null:
      return "nothing";
    case YAML::NodeType::Undefined:
      break;
  }
  return "something undefined";
}

std::string shortest(double value) {
  char text[32];
  // Counts are written out; an exponent goes without its plus sign and zeros.
  const bool count = value == std::floor(value) && std::abs(value) < 1e9;
  const auto end = count ? std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr
                         : std::to_chars(text, text + sizeof text, value).ptr;
  std::string shown{text, end};
  const std::size_t exponent = shown.find("e+");
  if (exponent != std::string::npos) shown.erase(exponent + 1, shown[exponent + 2] == '0' ? 2 : 1);
  return shown;
}

std::string joined(const std::vector<std::string>& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

Range Range::above(double low, const std::string& unit) {
  return {low, std::numeric_limits<double>::infinity(), false, unit};
}

Range Range::above(double low, double up_to, const std::string& unit) {
  return {low, up_to, false, unit};
}

Range Range::any(const std::string& unit) {
  Range range;
  range.unit = unit;
  return range;
}

Range Range::between(double low, double high, const std::string& unit) {
  return {low, high, true, unit};
}

std::string Range::description() const {
  std::string text;
  if (std::isfinite(low)) text = (low_allowed ? "at least " : "above ") + shortest(low);
  if (std::isfinite(high)) text += (text.empty() ? "at most " : " and at most ") + shortest(high);
  if (text.empty()) text = "any number";
  return unit.empty() ? text : text + " " + unit;
}

void YamlValue::refuse(const std::string& expectation, const std::string& answer) const {
  throw CaseError(
      fmt::format("{}: '{}': expected {}, got {}{}", _where, _path, expectation, describe(_node), answer));
}

void YamlValue::require_within(double value, const Range& range) const {
  if (range.contains(value)) return;
  throw CaseError(
      fmt::format("{}: '{}' is {}, but must be {}", _where, _path, shortest(value), range.description()));
}

double YamlValue::number(const Range& range) const {
  const std::optional<double> value = _node.IsScalar() ? parse_number(_node.Scalar()) : std::nullopt;
  if (!value) refuse("a number");
  require_within(*value, range);
  return *value;
}

std::optional<double> YamlValue::number_or(const Range& range, const std::string& word) const {
  if (_node.IsScalar() && _node.Scalar() == word) return std::nullopt;
  const std::optional<double> value = _node.IsScalar() ? parse_number(_node.Scalar()) : std::nullopt;
  if (!value) refuse(fmt::format("a number or '{}'", word));
  require_within(*value, range);
  return value;
}

std::int64_t YamlValue::integer(const Range& range) const {
  const std::optional<double> value = _node.IsScalar() ? parse_number(_node.Scalar()) : std::nullopt;
  if (!value || *value != std::floor(*value)) refuse("a whole number");
  require_within(*value, range);
  return static_cast<std::int64_t>(*value);
}

bool YamlValue::flag() const {
  bool value = false;
  if (!_node.IsScalar() || !YAML::convert<bool>::decode(_node, value)) refuse("true or false");
  return value;
}

std::string YamlValue::text() const {
  if (!_node.IsScalar() || _node.Scalar().empty()) refuse("a text");
  // What the system would take for the end: another file would be opened than the one that was named.
  if (_node.Scalar().find('\0') != std::string::npos) refuse("a text without NUL");
  return _node.Scalar();
}

std::string YamlValue::path() const {
  const std::string given = text();
  std::string result;
  std::size_t from = 0;
  for (std::size_t at; (at = given.find("${", from)) != std::string::npos;) {
    const std::size_t end = given.find('}', at);
    if (end == std::string::npos) refuse("a path in which each '${' has its '}'");
    const std::string name = given.substr(at + 2, end - at - 2);
    const char* const value = name.empty() ? nullptr : std::getenv(name.c_str());
    if (value == nullptr || *value == 0)
      throw CaseError(
          fmt::format("{}: '{}' names the environment variable '{}', which is not set. Remedy: "
                      "export {}=..., or a path without it",
                      _where, _path, shortened(name), shortened(name)));
    result.append(given, from, at - from).append(value);
    from = end + 1;
  }
  return result.append(given, from);
}

std::vector<std::string> YamlValue::texts() const {
  if (_node.IsScalar()) return {text()};
  if (!_node.IsSequence() || _node.size() == 0) refuse("a list of texts");
  std::vector<std::string> all;
  for (const auto& item : _node) {
    if (!item.IsScalar() || item.Scalar().empty() || item.Scalar().find('\0') != std::string::npos)
      refuse("a list of texts");
    all.push_back(item.Scalar());
  }
  return all;
}

geometry::Vec3 YamlValue::point() const {
  if (!_node.IsSequence() || _node.size() != 3) refuse("a list of three numbers");
  geometry::Vec3 point;
  for (int axis = 0; axis < 3; ++axis) {
    const YAML::Node item = _node[axis];
    const std::optional<double> value = item.IsScalar() ? parse_number(item.Scalar()) : std::nullopt;
    if (!value) refuse("a list of three numbers");
    point[axis] = *value;
  }
  return point;
}

std::pair<geometry::Vec3, geometry::Vec3> YamlValue::points() const {
  const char* const wanted = "a list of two points, such as [[0, 0, 0], [1, 1, 1]]";
  if (!_node.IsSequence() || _node.size() != 2) refuse(wanted);
  std::array<geometry::Vec3, 2> both;
  for (int i = 0; i < 2; ++i) {
    const YAML::Node item = _node[i];
    if (!item.IsSequence()) refuse(wanted);
    both[i] = YamlValue(item, _path, _where).point();
  }
  return {both[0], both[1]};
}

std::pair<double, double> YamlValue::interval() const {
  const char* const wanted = "a list of two numbers, the smaller one first";
  if (!_node.IsSequence() || _node.size() != 2) refuse(wanted);
  std::array<double, 2> both{};
  for (int i = 0; i < 2; ++i) {
    const YAML::Node item = _node[i];
    const std::optional<double> value = item.IsScalar() ? parse_number(item.Scalar()) : std::nullopt;
    if (!value) refuse(wanted);
    both[i] = *value;
  }
  if (both[0] > both[1]) refuse(wanted);
  return {both[0], both[1]};
}

std::size_t YamlValue::choice(const std::vector<std::string>& names) const {
  const auto found = _node.IsScalar() ? std::find(names.begin(), names.end(), _node.Scalar()) : names.end();
  if (found == names.end()) {
    const auto answer = _node.IsScalar() ? answer_to_value(_node.Scalar()) : std::nullopt;
    refuse((names.size() > 1 ? "one of " : "") + joined(names), answer ? "; " + *answer : "");
  }
  return static_cast<std::size_t>(found - names.begin());
}

std::vector<std::size_t> YamlValue::choices(const std::vector<std::string>& names) const {
  std::vector<std::size_t> all;
  const auto add = [&](const YAML::Node& item) {
    const std::size_t chosen = YamlValue(item, _path, _where).choice(names);
    if (std::find(all.begin(), all.end(), chosen) == all.end()) all.push_back(chosen);
  };
  if (!_node.IsSequence()) {
    add(_node);
  } else {
    for (const auto& item : _node) add(item);
  }
  if (all.empty()) refuse("one at least of " + joined(names));
  return all;
}

}  // namespace aeroloom::cases
