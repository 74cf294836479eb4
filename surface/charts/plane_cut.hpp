/// Cutting a chart surface in two by a plane.
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

/// Planes to cut by, the most promising first: those that leave flat, balanced sides behind a short cut.
std::vector<CutPlane> propose_planes(const ChartSurface& surface);

/// Divides the triangles along the plane, into parts 0 and 1. Where it meets the boundary the cut bends to a
/// mesh vertex; parts that are too small stay with their neighbour. Nothing when only one part is left.
std::optional<CutSurface> cut_by_plane(const ChartSurface& surface, const CutPlane& plane);

}  // namespace aeroloom::surface
