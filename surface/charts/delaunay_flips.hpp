/// Delaunay flips of a parametric triangulation.
#pragma once

#include "surface/charts/chart_surface.hpp"

namespace aeroloom::surface {

/// Flips edges between nearly coplanar triangles until the two angles opposite each edge sum to at most 180
/// degrees. No edge is flipped across a seam, or where space or the parameter plane would fold.
void flip_to_delaunay(ChartSurface& surface);

/// The first fundamental form of a surface at a point: the metric of parameter differences.
struct SurfaceMetric {
  double uu = 0, uv = 0, vv = 0;
};

/// Flips edges in the parameter plane, for a triangulation that is open along seams. First removes triangles
/// of the wrong orientation where possible, then makes the others Delaunay in the metric of the surface.
/// Triangles need not be flat in space. `metrics`: per point. `same`: per point, a number that coincident
/// points share; no edge may join these. `orientation`: 1 where triangles are counter-clockwise in this
/// plane, else -1.
void flip_in_parameters(ChartSurface& surface, const std::vector<SurfaceMetric>& metrics,
                        const std::vector<std::int32_t>& same, int orientation);

}  // namespace aeroloom::surface
