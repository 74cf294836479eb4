/// An order of tetrahedra that keeps neighbours close in memory.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// The indices of cells, sorted by the place of their centroids along the Morton curve.
std::vector<std::uint32_t> order_along_curve(std::span<const geometry::Vec3> points,
                                             std::span<const std::array<mesh::LocalIndex, 4>> cells);

}  // namespace aeroloom::volume
