/// Whether the cells over a wall triangle are good.
#pragma once

#include "layers/column_heights.hpp"

#include <array>
#include <cstdint>

namespace aeroloom::layers {

/// A column as the cells of one triangle see it.
struct CornerColumn {
  geometry::Vec3 point, direction;
  Heights heights;
  std::int32_t count = 0;
};
/// Corners counter-clockwise seen from the fluid.
using TriangleColumns = std::array<CornerColumn, 3>;

/// The number of layers from the wall whose cells are good: exactly positive all twelve tetrahedra of prisms,
/// all four of pyramids, and tetrahedra themselves; the scaled Jacobian of prisms at least half of that at
/// vanishing height. Where all are, the smallest angle of the front's triangle is at least 0.6 of the wall
/// triangle's, else the last layer counts as bad.
std::int32_t good_layers(const TriangleColumns& columns);

/// The height of each column's first `layers` layers, clipped at its count.
std::array<double, 3> heights_at(const TriangleColumns& columns, std::int32_t layers);

}  // namespace aeroloom::layers
