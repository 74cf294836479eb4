/// An order of tetrahedra in which neighbours are near each other in memory.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// Cells by the place of their centroid along a space-filling curve.
std::vector<std::uint32_t> order_along_curve(std::span<const geometry::Vec3> points,
                                             std::span<const std::array<mesh::LocalIndex, 4>> cells);

}  // namespace aeroloom::volume
