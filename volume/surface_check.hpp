/// What is wrong with a surface that shall be filled.
#pragma once

#include "volume/boundary_distance.hpp"
#include "volume/volume_mesher.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::volume {

/// A defect and the triangles it is at.
struct SurfaceDefect {
  std::string what;                     ///< empty: none found
  std::vector<std::int32_t> triangles;  ///< ascending, each once
};

/// Indices out of range, coordinates that are not finite, triangles without area, points used by no triangle
/// or coincident, edges whose triangles do not match up in pairs of opposite direction.
SurfaceDefect find_defect(const ClosedSurface& surface);

/// Triangles that meet elsewhere than in common vertices and edges. Exact.
SurfaceDefect find_intersections(const ClosedSurface& surface, const BoundaryDistance& tree);

/// A line per triangle: index, centre, shortest and longest edge; at most ten of them, then how many more.
std::string describe_triangles(const ClosedSurface& surface, const std::vector<std::int32_t>& triangles);

}  // namespace aeroloom::volume
