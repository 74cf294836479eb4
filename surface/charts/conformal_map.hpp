/// Maps of a parametric triangulation to the plane. They need not be one-to-one: judge_map() checks that.
#pragma once

#include "surface/charts/chart_surface.hpp"

#include <optional>
#include <vector>

namespace aeroloom::surface {

using PlaneMap = std::vector<geometry::Vec2>;  ///< per point of the surface

/// Parallel projection along the mean normal. Isometric where the surface is planar.
PlaneMap project_to_mean_plane(const ChartSurface& surface);

/// The spectral conformal map (Mullen, Tong, Alliez and Desbrun, Comput. Graph. Forum 27, 2008,
/// doi:10.1111/j.1467-8659.2008.01289.x). Of all maps with a boundary of given size it has the least
/// conformal energy. The boundary is free and any number of holes is allowed. Found by inverse iteration from
/// `start`, then scaled to the area of the surface. Nothing where the factorisation fails.
std::optional<PlaneMap> map_conformally(const ChartSurface& surface, const PlaneMap& start);

/// Makes the scale of a map more even, by local-global steps towards a rigid map (Liu, Zhang, Xu, Gotsman and
/// Gortler, Comput. Graph. Forum 27, 2008, doi:10.1111/j.1467-8659.2008.01290.x).
std::optional<PlaneMap> map_rigidly(const ChartSurface& surface, const PlaneMap& start, int steps);

/// The CAD parameters, scaled to mean lengths of the surface. Nothing where a seam or pole lies inside.
std::optional<PlaneMap> scale_parameters(const ChartSurface& surface);

/// How far a map is from an isometry, up to one scale factor.
struct MapQuality {
  double folded = 1;           ///< fraction of the area in triangles that turn over or collapse (exact signs)
  double stretch = 1e300;      ///< largest ratio of singular values, on all but 1 % of the area
  double scale_ratio = 1e300;  ///< largest ratio of scales, 0.5 % of the area left out at either end
  double overlap = 1;          ///< estimated fraction of the area that lies over other parts of the map
  bool loops_cross = true;     ///< chords between mesh vertices of the boundary cross
};
MapQuality judge_map(const ChartSurface& surface, const PlaneMap& map);

/// Largest angle between a normal and the mean normal, on all but 1 % of the area; radians.
double normal_spread(const ChartSurface& surface);

/// Length in the chart over length in space, per point of the surface.
std::vector<double> point_scales(const ChartSurface& surface, const PlaneMap& map);

}  // namespace aeroloom::surface
