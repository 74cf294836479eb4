/// TetGen behind our types. It may throw, abort, hang or exhaust memory: call it in a contained run only.
#pragma once

#include "mesh/piece.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// When the interior points enter.
enum class InteriorPoints : std::uint8_t {
  at_once,         ///< with the surface's points, before the boundary is recovered: fastest
  after_recovery,  ///< into the recovered boundary: slower, but they cannot stand in its way
};

/// What TetGen makes of a surface and interior points, unverified: the convex hull of the surface less what
/// lies outside its outer shells. Voids are still filled.
struct TetgenMesh {
  std::vector<double> added;  ///< (s,3) Steiner points, numbered after the given ones
  std::vector<std::array<mesh::LocalIndex, 4>> cells;  ///< positive volume in VTK's order
  /// The cell across the face opposite to each vertex; -1 where a surface triangle or nothing is.
  std::vector<std::array<std::int32_t, 4>> neighbours;
};

/// `coordinates` (n,3): the surface's `surface_points` points first. Should be of unit size. Throws
/// std::runtime_error.
TetgenMesh run_tetgen(std::span<const double> coordinates, std::size_t surface_points,
                      std::span<const std::array<mesh::LocalIndex, 3>> triangles, InteriorPoints interior);

}  // namespace aeroloom::volume
