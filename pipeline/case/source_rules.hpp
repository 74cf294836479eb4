/// What the case says of places where elements are small.
#pragma once

#include "geometry/vec.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::sizing {
struct SizeRegion;
struct WakeSize;
struct WallSize;
struct EdgeSize;
}  // namespace aeroloom::sizing

namespace aeroloom::cases {

/// A source of sizes as it is written, or in the model's unit.
struct SourceRule {
  std::string name;
  sizing::SizeShape shape;
  double size = 0;  ///< largest size within; of a wake where it begins
};

/// A band of small elements off walls as it is written.
struct WallRule {
  std::string name;
  std::vector<std::string> faces;  ///< patterns; none: all walls
  std::optional<double> size, distance;
};

/// Sizes along CAD edges as they are written.
struct EdgeRule {
  std::string name;
  std::vector<std::string> between;         ///< patterns of faces
  std::optional<geometry::Vec3> low, high;  ///< corners of a box
  std::optional<double> size;
};

/// What rules ask for that have all they need.
sizing::WallSize wall_of(const WallRule& rule);
sizing::EdgeSize edge_of(const EdgeRule& rule);

}  // namespace aeroloom::cases
