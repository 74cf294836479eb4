/// Finds defects of a surface that prevent filling.
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

/// A kind of defect and the triangles that have it.
struct SurfaceDefect {
  std::string what;                     ///< text for the user; empty: no defect
  std::vector<std::int32_t> triangles;  ///< ascending, each once
};

/// Finds indices out of range, coordinates that are not finite, triangles without area, and different points
/// at the same place.
SurfaceDefect find_defect(const TriangleSoup& surface);

/// Finds triangles that meet elsewhere than in common vertices and edges. Exact.
SurfaceDefect find_intersections(const TriangleSoup& surface, const BoundaryDistance& tree);

/// One line for each of the first ten triangles: index, centre, shortest and longest edge. Then how many
/// more.
std::string describe_triangles(const TriangleSoup& surface, const std::vector<std::int32_t>& triangles);

}  // namespace aeroloom::volume
