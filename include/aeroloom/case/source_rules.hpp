/// What the case says of places where elements are small.
#pragma once

#include "aeroloom/geometry/vec.hpp"
#include "aeroloom/sizing/size_demands.hpp"

#include <optional>
#include <string>

namespace aeroloom::cases {

enum class SourceShape { point, line, sphere, box, cylinder, cone };

/// A source of sizes as it is written, in the model's unit.
struct SourceRule {
  std::string name;
  std::optional<SourceShape> shape;
  std::optional<geometry::Vec3> center;     ///< of a point, sphere
  std::optional<geometry::Vec3> low, high;  ///< corners of a box
  std::optional<geometry::Vec3> from, to;   ///< ends of a line, cylinder, cone
  std::optional<double> radius;             ///< of a sphere, cylinder; of a cone at `from`
  std::optional<double> end_radius;         ///< of a cone at `to`
  std::optional<double> size;               ///< largest size within
};

/// The region of a rule that has all that its shape needs.
sizing::SizeRegion region_of(const SourceRule& rule);

}  // namespace aeroloom::cases
