/// Cuts a parametric triangulation in two by a plane, or along a line on it.
#pragma once

#include "surface/charts/cut_curves.hpp"

#include <optional>
#include <vector>

namespace aeroloom::surface {

/// The points x with dot(normal, x) = offset.
struct CutPlane {
  geometry::Vec3 normal;
  double offset;
};

/// Candidate planes, the best first: those with flat sides of similar area and a short cut.
std::vector<CutPlane> propose_planes(const ChartSurface& surface);

/// Divides the triangles along the plane into parts 0 and 1. Near the boundary the cut bends to a mesh
/// vertex. Components that are too small join their neighbour. Nothing where only one part is left.
std::optional<CutSurface> cut_by_plane(const ChartSurface& surface, const CutPlane& plane);

/// As cut_by_plane(), where a function given at the points is zero. It should change by about the distance
/// from there. Parts may be much smaller.
std::optional<CutSurface> cut_by_levels(const ChartSurface& surface, std::vector<double> levels);

}  // namespace aeroloom::surface
