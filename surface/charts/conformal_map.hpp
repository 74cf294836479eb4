/// Maps of a chart surface to the plane. None of them promises to be one-to-one: judge_map() tells.
#pragma once

#include "surface/charts/chart_surface.hpp"

#include <optional>
#include <vector>

namespace aeroloom::surface {

using PlaneMap = std::vector<geometry::Vec2>;  ///< per chart surface point

/// Parallel projection along the mean normal; isometric on a planar chart surface.
PlaneMap project_to_mean_plane(const ChartSurface& surface);

/// The spectral conformal map (Mullen, Tong, Alliez and Desbrun, Comput. Graph. Forum 27, 2008,
/// doi:10.1111/j.1467-8659.2008.01289.x): of all maps whose boundary has a given size, the one with the least
/// conformal energy (that of least squares conformal maps). Free boundary, any number of holes. Found by
/// inverse iteration from `start`. Scaled to the chart surface's area. Nothing when the factorisation fails.
std::optional<PlaneMap> map_conformally(const ChartSurface& surface, const PlaneMap& start);

/// Evens out the scale of a map: local-global steps as rigid as possible (Liu, Zhang, Xu, Gotsman and
/// Gortler, Comput. Graph. Forum 27, 2008, doi:10.1111/j.1467-8659.2008.01290.x).
std::optional<PlaneMap> map_rigidly(const ChartSurface& surface, const PlaneMap& start, int steps);

/// The CAD parameters, scaled to mean lengths of the surface. Nothing where a seam or pole lies inside the
/// chart surface.
std::optional<PlaneMap> scale_parameters(const ChartSurface& surface);

/// How far a map is from an isometry up to one factor.
struct MapQuality {
  double folded = 1;           ///< fraction of the area in triangles that turn over or collapse (exact signs)
  double stretch = 1e300;      ///< largest ratio of singular values, on all but 1 % of the area
  double scale_ratio = 1e300;  ///< largest ratio of scales, 0.5 % of the area left out at either end
  double overlap = 1;          ///< fraction of the area that lies over other parts of the map, about
  bool loops_cross = true;     ///< chords between mesh vertices of the boundary cross: a hole was squeezed
};
MapQuality judge_map(const ChartSurface& surface, const PlaneMap& map);

/// Largest angle between a normal and their mean, on all but 1 % of the area; radians.
double normal_spread(const ChartSurface& surface);

/// Chart length over length in space, per chart surface point.
std::vector<double> point_scales(const ChartSurface& surface, const PlaneMap& map);

}  // namespace aeroloom::surface
