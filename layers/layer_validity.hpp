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
/// vanishing height.
std::int32_t good_layers(const TriangleColumns& columns);
/// Whether the smallest angle of the cap's triangle is at least 0.6 of the wall triangle's, and the
/// uppermost prism has its scaled Jacobian: what most often fails, and quickly told.
bool has_good_cap(const TriangleColumns& columns);

/// A height that no column over the triangle may exceed so that cap and cells become good, below the
/// highest of them: the tallest columns fall first. Infinite where all is good. Where columns below it still
/// are not, the next answer is lower.
double fitting_height(const TriangleColumns& columns);

}  // namespace aeroloom::layers
