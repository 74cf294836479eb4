/// Values of a YAML file, and what keys accept.
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

/// The numbers a key accepts.
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
  /// As in "above 1 and at most 3 degrees".
  std::string description() const;
};

/// A value in a file or on the command line, as the readers of single keys see it.
class YamlValue {
public:
  YamlValue(const YAML::Node& node, std::string path, std::string where)
      : _node(node), _path(std::move(path)), _where(std::move(where)) {}
  /// Each throws CaseError when the value is something else.
  double number(const Range& range) const;
  /// Nothing where the word is there instead.
  std::optional<double> number_or(const Range& range, const std::string& word) const;
  std::int64_t integer(const Range& range) const;
  bool flag() const;
  std::string text() const;
  /// A text in which `${NAME}` is replaced by the environment variable NAME. Throws CaseError, too, when no
  /// such variable is set.
  std::string path() const;
  /// A list of texts, or one text alone.
  std::vector<std::string> texts() const;
  /// A list of three finite numbers.
  geometry::Vec3 point() const;
  /// A list of two of them.
  std::pair<geometry::Vec3, geometry::Vec3> points() const;
  /// A list of two finite numbers, the smaller one first.
  std::pair<double, double> interval() const;
  /// The position among `names`.
  std::size_t choice(const std::vector<std::string>& names) const;
  /// The positions of a list, or of one alone, each once.
  std::vector<std::size_t> choices(const std::vector<std::string>& names) const;

private:
  [[noreturn]] void refuse(const std::string& expectation) const;
  void require_within(double value, const Range& range) const;

  const YAML::Node& _node;
  std::string _path, _where;
};

/// What a node is, in the words of a message.
std::string describe(const YAML::Node& node);
/// A text for a message: its beginning, without control characters.
std::string shortened(const std::string& text);
/// A short text that reads back as the same number, such as 0.1, 1000000 or 1e9.
std::string shortest(double value);
/// Names with commas between them.
std::string joined(const std::vector<std::string>& names);

}  // namespace aeroloom::cases
