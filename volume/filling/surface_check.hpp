/// Defects of a part of a surface that is to bound tetrahedra.
#pragma once

#include "volume/lattice/boundary_distance.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::volume {

/// Triangles and the points they use.
struct TriangleSoup {
  std::span<const geometry::Vec3> points;
  std::span<const std::array<mesh::LocalIndex, 3>> triangles;
};

/// A defect and the triangles it is at.
struct SurfaceDefect {
  std::string what;                     ///< empty: none found
  std::vector<std::int32_t> triangles;  ///< ascending, each once
};

/// Indices out of range, coordinates that are not finite, triangles without area, different points at the
/// same place.
SurfaceDefect find_defect(const TriangleSoup& surface);

/// Triangles that meet elsewhere than in common vertices and edges. Exact.
SurfaceDefect find_intersections(const TriangleSoup& surface, const BoundaryDistance& tree);

/// A line per triangle: index, centre, shortest and longest edge; at most ten of them, then how many more.
std::string describe_triangles(const TriangleSoup& surface, const std::vector<std::int32_t>& triangles);

}  // namespace aeroloom::volume
