/// TetGen behind our types. It may throw, abort, hang or exhaust memory: call it in a sandboxed run only.
#pragma once

#include "mesh/data/piece.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// TetGen's mesh of points and of triangles between some of them, unverified: the convex hull of all.
struct TetgenMesh {
  std::vector<double> added;  ///< (s,3) Steiner points, numbered after the given ones
  std::vector<std::array<mesh::LocalIndex, 4>> cells;  ///< positive volume in VTK's order
  /// The cell across the face opposite to each vertex; -1 where nothing is, -2 - t where triangle t is.
  std::vector<std::array<std::int32_t, 4>> neighbours;
};
/// Stands for a neighbour that was not asked for.
inline constexpr std::int32_t not_asked_for = INT32_MAX;

/// The Delaunay mesh of points (n,3), changed where it takes that for all triangles to be faces. The
/// triangles need not be closed. The order of the points decides where more than four lie on a sphere.
/// Coordinates should be of unit size. `asked_for` marks the points whose cells are asked for, and no others
/// come unless TetGen had to add points; empty: all cells. Throws std::runtime_error.
TetgenMesh run_tetgen(std::span<const double> coordinates,
                      std::span<const std::array<mesh::LocalIndex, 3>> triangles,
                      std::span<const std::uint8_t> asked_for = {});

}  // namespace aeroloom::volume
