/// From TetGen's cells to the filling of a piece: what is inside, proof that it is right, order.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/piece.hpp"
#include "volume/tetgen_run.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

using Triangle = std::array<mesh::LocalIndex, 3>;
using Cell = std::array<mesh::LocalIndex, 4>;

/// The cells on the inner side of the surface, found by spreading from the surface's triangles: each knows
/// which of its sides is inside, so voids need no hole points. Throws std::runtime_error when a triangle is
/// missing or sides contradict each other.
std::vector<Cell> cells_inside(const TetgenMesh& mesh, std::span<const Triangle> triangles);

/// Throws std::runtime_error unless all cells have positive volume (exact) and their boundary is the surface,
/// triangle by triangle. Both together prove that the cells cover the inside exactly once. The second is
/// checked by a sum of 64-bit hashes over oriented faces, in which inner faces cancel.
void check_filling(std::span<const geometry::Vec3> points, std::span<const Cell> cells,
                   std::span<const Triangle> triangles);

/// Removes points that no cell uses, from `first_removable` on, and renumbers. Returns for each old point
/// whether it stayed. Throws std::runtime_error when a point before `first_removable` is unused.
std::vector<std::uint8_t> drop_unused_points(std::vector<geometry::Vec3>& points, std::vector<Cell>& cells,
                                             std::size_t first_removable);

/// Sorts cells by the place of their centroid along a space-filling curve.
void sort_along_curve(std::span<const geometry::Vec3> points, std::vector<Cell>& cells);

}  // namespace aeroloom::volume
