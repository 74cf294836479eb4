/// Tests whether the layer cells over a wall triangle are good.
#pragma once

#include "layers/bends.hpp"
#include "layers/column_heights.hpp"
#include "layers/curved_ends.hpp"
#include "layers/layer_shapes.hpp"

#include <array>
#include <cstdint>

namespace aeroloom::layers {

/// One of the three columns over a triangle.
struct CornerColumn {
  geometry::Vec3 point, direction;
  Heights heights;
  std::int32_t count = 0;
  const CurvedEnds* ends = nullptr;  ///< of a column on curved faces: they, and what it follows
  const EndPlace* end = nullptr;
  const Bend* bend = nullptr;  ///< of one that bends

  bool is_straight() const { return end == nullptr && bend == nullptr; }
  geometry::Vec3 at(double height) const {
    const geometry::Vec3 straight = point + height * direction;
    const geometry::Vec3 bent = bend == nullptr ? straight : straight + bend->at(height);
    return end == nullptr ? bent : ends->onto(*end, bent);
  }
  /// Unit, of the column at a height.
  geometry::Vec3 direction_at(double height) const {
    constexpr double below = 0.9;
    return is_straight() || height == 0 ? direction : normalized(at(height) - at(below * height));
  }
};
/// Corners counter-clockwise seen from the fluid.
using TriangleColumns = std::array<CornerColumn, 3>;

/// The number of layers, counted from the wall, whose cells are all good. The volumes of all corner
/// tetrahedra must be positive by exact predicates: twelve in a prism, four in a pyramid. The scaled Jacobian
/// of a prism must be at least half of its value at vanishing height.
std::int32_t good_layers(const TriangleColumns& columns);
/// Whether the cap triangle and the uppermost prism are good. The smallest angle of the cap triangle must be
/// at least 0.6 of the wall triangle's; the prism must meet the scaled Jacobian bound of good_layers(). This
/// cheap test finds most failures.
bool has_good_cap(const TriangleColumns& columns);

/// A bound on the column heights over the triangle that brings cap and cells closer to being good. It is at
/// most 0.95 of the highest column, so the tallest columns shrink first. Where counts differ it is little
/// less, for columns are then fitted again. Infinite if all is good. If a bound does not suffice, the next
/// call returns a lower one.
double fitting_height(const TriangleColumns& columns);

/// The columns over a face of a fan.
struct FanColumns {
  LayersOverFan over;
  std::array<CornerColumn, 4> columns;
};

/// The apex of the pyramid on the uppermost cell of a sector, whose top is a quadrilateral.
geometry::Vec3 sector_apex(const std::array<geometry::Vec3, 4>& top,
                           const std::array<geometry::Vec3, 4>& directions);

/// As fitting_height() of a triangle for the cells over a face of a fan, whose corners must all span a
/// positive volume.
double fitting_height(const FanColumns& fan);
/// Whether those of the lowest one do.
bool has_good_first_layer(const FanColumns& fan);

}  // namespace aeroloom::layers
