/// Delaunay flips of a chart surface.
#pragma once

#include "surface/charts/chart_surface.hpp"

namespace aeroloom::surface {

/// Flips edges between nearly coplanar triangles until the angles opposite each sum to no more than 180
/// degrees. A flip keeps boundary and uv consistent: it is not made across a seam, nor where it would fold
/// space or parameter plane.
void flip_to_delaunay(ChartSurface& surface);

/// The first fundamental form of a surface at a point: lengths of parameter differences.
struct SurfaceMetric {
  double uu = 0, uv = 0, vv = 0;
};

/// Flips in the parameter plane, where a triangulation that is open along seams cannot fold: triangles of
/// the wrong orientation are flipped away where possible, the others are made Delaunay in the metric of the
/// surface. Neither position nor flatness in space matters. `metrics` per point; `same` per point: a name
/// that points share which are one in space (no edge may join them); `orientation`: 1 where triangles are
/// counter-clockwise in this plane, else -1.
void flip_in_parameters(ChartSurface& surface, const std::vector<SurfaceMetric>& metrics,
                        const std::vector<std::int32_t>& same, int orientation);

}  // namespace aeroloom::surface
