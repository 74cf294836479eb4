#include "pipeline/case/given_lengths.hpp"

#include "pipeline/case/case_keys.hpp"
#include "pipeline/case/yaml_reader.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <fmt/format.h>

namespace aeroloom::cases {

namespace {

/// Over the body's largest extent. Below, sizes are finer than coordinates are apart; above, no length
/// matters any more. What a machine can hold is judged from counts, later. Chosen, not measured.
constexpr double least_of_body = 1e-9, most_of_body = 1e9;
/// Numbers at the body's farthest coordinate that a length spans at least: angles of elements are then right
/// to half a degree.
constexpr double least_spacings = 100;

/// The numbers in a value as YAML; none in a word.
std::vector<double> numbers_in(const std::string& yaml) {
  std::vector<double> numbers;
  const char* at = yaml.c_str();
  while (*at != '\0') {
    char* end = nullptr;
    const double number = std::strtod(at, &end);
    if (end == at) {
      ++at;
      continue;
    }
    numbers.push_back(number);
    at = end;
  }
  return numbers;
}

/// Whether the key counts in reference lengths.
bool is_relative(const std::string& key) {
  if (key.starts_with("sizing.")) return key != "sizing.reference_length";
  return (key.starts_with("groups.") || key.starts_with("patches.")) && key.ends_with(".size");
}

}  // namespace

std::vector<GivenLength> given_lengths(const KeyTable& keys, double reference_length) {
  std::vector<GivenLength> lengths;
  for (const KeyInfo& info : keys.infos()) {
    const bool is_place = info.kind == KeyKind::point;
    if (!is_place && (info.kind != KeyKind::number || info.range.unit != length_unit)) continue;
    std::string where = keys.where(info.path);
    if (where.empty()) continue;
    std::vector<double> values = numbers_in(info.default_value);
    if (values.size() != (is_place ? 3 : 1)) continue;
    lengths.push_back({info.path, std::move(where), std::move(values), is_place || info.range.low < 0,
                       info.range.contains(0), is_relative(info.path) ? reference_length : 1});
  }
  return lengths;
}

std::string fault_of_lengths(const std::vector<GivenLength>& lengths, const geometry::Box& body) {
  const geometry::Vec3 size = body.size();
  const double extent = std::max({size.x, size.y, size.z});
  double farthest = 0;
  for (const geometry::Vec3& corner : {body.low, body.high})
    farthest = std::max({farthest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
  const double spacing = std::nextafter(farthest, std::numeric_limits<double>::infinity()) - farthest;
  const double least = least_of_body * extent, distinct = least_spacings * spacing,
               most = most_of_body * extent;
  for (const GivenLength& length : lengths) {
    for (const double value : length.values) {
      const double in_model = value * length.unit;
      if (!length.is_place && in_model >= least && in_model < distinct) {
        return fmt::format(
            "{}: '{}' is {}, but the body reaches out to {:.3g}, where numbers of the computer are {:.2g} "
            "apart: a length has at least {:.3g}. Remedy: a model near the origin, or larger sizes",
            length.where, length.key, shortest(in_model), farthest, spacing, distinct);
      }
      if (length.is_place ? std::abs(in_model) <= most + farthest
                          : (in_model >= least && in_model <= most) || (value == 0 && length.may_be_zero))
        continue;
      const std::string counted =
          length.unit == 1 ? "" : fmt::format(" (times 'sizing.reference_length': {:.3g})", in_model);
      return fmt::format(
          "{}: '{}' is {}{}, but must be {} {:.3g} in the unit of the geometry: the body is {:.6g} long, and "
          "{:g} to {:g} times that is what a length of it may be",
          length.where, length.key, shortest(value), counted,
          length.is_place ? "no farther away than" : fmt::format("at least {:.3g} and at most", least),
          length.is_place ? most + farthest : most, extent, least_of_body, most_of_body);
    }
  }
  return {};
}

}  // namespace aeroloom::cases
