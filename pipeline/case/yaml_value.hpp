/// Values of a YAML file, and the ranges that keys accept.
#pragma once

#include "geometry/vec.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace YAML {
class Node;
}  // namespace YAML

namespace aeroloom::cases {

/// The numbers that a key accepts.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_allowed = true;
  std::string unit;

  static Range any(const std::string& unit);
  static Range above(double low, const std::string& unit = "");
  static Range above(double low, double up_to, const std::string& unit = "");
  static Range between(double low, double high, const std::string& unit = "");
  bool contains(double value) const { return (low_allowed ? value >= low : value > low) && value <= high; }
  /// In words: "above 1 and at most 3 degrees".
  std::string description() const;
};

/// A value from a file or the command line.
class YamlValue {
public:
  YamlValue(const YAML::Node& node, std::string path, std::string where)
      : _node(node), _path(std::move(path)), _where(std::move(where)) {}
  /// Each function throws CaseError if the value has another form.
  double number(const Range& range) const;
  /// Empty for the word.
  std::optional<double> number_or(const Range& range, const std::string& word) const;
  std::int64_t integer(const Range& range) const;
  bool flag() const;
  std::string text() const;
  /// A text with `${NAME}` replaced by the environment variable NAME. Also throws CaseError if it is not set.
  std::string path() const;
  /// A list of texts, or a single text.
  std::vector<std::string> texts() const;
  /// A list of three finite numbers.
  geometry::Vec3 point() const;
  /// A list of two points.
  std::pair<geometry::Vec3, geometry::Vec3> points() const;
  /// A list of two finite numbers, smaller one first.
  std::pair<double, double> interval() const;
  /// The index in `names`.
  std::size_t choice(const std::vector<std::string>& names) const;
  /// The indices of a list or a single name, each once.
  std::vector<std::size_t> choices(const std::vector<std::string>& names) const;

private:
  /// `answer`: what is said besides, with its semicolon.
  [[noreturn]] void refuse(const std::string& expectation, const std::string& answer = "") const;
  void require_within(double value, const Range& range) const;

  const YAML::Node& _node;
  std::string _path, _where;
};

/// The kind of a node, for messages.
std::string describe(const YAML::Node& node);
/// The beginning of a text without control characters, for messages.
std::string shortened(const std::string& text);
/// The shortest text that reads back as the same number: 0.1, 1000000, 1e9.
std::string shortest(double value);
/// The names, separated by commas.
std::string joined(const std::vector<std::string>& names);

}  // namespace aeroloom::cases
