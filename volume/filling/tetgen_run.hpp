/// Runs TetGen. It may throw, abort, hang or exhaust memory: call it in a sandboxed child only.
#pragma once

#include "mesh/data/piece.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// TetGen's mesh of the convex hull of all points. Nothing is checked.
struct TetgenMesh {
  std::vector<double> added;  ///< (s,3) Steiner points, numbered after the given ones
  std::vector<std::array<mesh::LocalIndex, 4>> cells;  ///< positive volume in VTK's order
  /// The cell behind the face opposite to each vertex; -1: none; -2 - t: the face is triangle t.
  std::vector<std::array<std::int32_t, 4>> neighbours;
};
/// Stands for a neighbour that was not requested.
inline constexpr std::int32_t not_requested = INT32_MAX;

/// The constrained Delaunay mesh of points (n,3): all triangles are faces. The triangles need not be closed.
/// Ties of more than four points on a sphere are broken by the order of the points. Coordinates should be of
/// unit size. `requested` marks points: only their cells are returned, unless TetGen had to add points.
/// Empty: all cells. Throws std::runtime_error.
TetgenMesh run_tetgen(std::span<const double> coordinates,
                      std::span<const std::array<mesh::LocalIndex, 3>> triangles,
                      std::span<const std::uint8_t> requested = {});

}  // namespace aeroloom::volume
