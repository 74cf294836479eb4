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

enum class SourceShape { point, line, sphere, box, cylinder, cone, wake };

/// A source of sizes as it is written, in the model's unit.
struct SourceRule {
  std::string name;
  std::optional<SourceShape> shape;
  std::optional<geometry::Vec3> center;     ///< of a point, sphere
  std::optional<geometry::Vec3> low, high;  ///< corners of a box
  std::optional<geometry::Vec3> from, to;   ///< ends of a line, cylinder, cone; of where a wake begins
  std::optional<double> radius;             ///< of a sphere, cylinder; of a cone at `from`
  std::optional<double> end_radius;         ///< of a cone at `to`
  std::vector<std::string> behind;          ///< patterns of faces at whose trailing edges a wake begins
  std::optional<geometry::Vec3> direction;  ///< of a wake
  std::optional<double> length;             ///< of a wake
  std::optional<double> size;               ///< largest size within; of a wake where it begins
  std::optional<double> end_size;           ///< where a wake ends; left out: as `size`
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

/// The region of a rule that has all that its shape needs, and is no wake.
sizing::SizeRegion region_of(const SourceRule& rule);
/// What rules ask for that have all they need.
sizing::WakeSize wake_of(const SourceRule& rule);
sizing::WallSize wall_of(const WallRule& rule);
sizing::EdgeSize edge_of(const EdgeRule& rule);

}  // namespace aeroloom::cases
