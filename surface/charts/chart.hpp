/// Charts: maps of a parametric triangulation to the plane with low distortion. They are least squares
/// conformal maps (Levy, Petitjean, Ray and Maillot, ACM Trans. Graph. 21, 2002, doi:10.1145/566654.566590).
/// A surface that one chart cannot hold is split (Remacle et al., Int. J. Numer. Meth. Engng 83, 2010,
/// doi:10.1002/nme.2824; Marchandise et al., J. Comput. Phys. 234, 2013, doi:10.1016/j.jcp.2012.09.012).
#pragma once

#include "cad/model/model.hpp"
#include "geometry/plane_grid.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/charts/chart_surface.hpp"
#include "surface/charts/cut_curves.hpp"

#include <vector>

namespace aeroloom::surface {

/// A triangulation with a one-to-one map to the plane.
struct Chart {
  ChartSurface surface;
  std::vector<geometry::Vec2> plane;  ///< per point of the surface
  std::vector<double> scale;          ///< per point of the surface: length in the chart over length in space
};

/// The place on the triangulation that belongs to a point of the chart.
struct ChartPoint {
  std::int32_t triangle = 0;
  std::array<double, 3> weights{};  ///< barycentric; negative where the point lies outside the triangle
  geometry::Vec3 point;             ///< on the facets
  geometry::Vec2 uv;                ///< interpolated
};

/// Finds the place of a chart point. Walks from a hint first, then searches a uniform grid. Outside the chart
/// it takes the nearest triangle. Triangles that are folded in the plane are never found.
class ChartLocator {
public:
  /// The chart must outlive the locator.
  explicit ChartLocator(const Chart& chart);
  /// `hint` is the triangle to start from, with any value allowed; it receives the triangle found. Outside
  /// the chart the point is extrapolated from the nearest triangle. The parameters are not extrapolated.
  ChartPoint locate(geometry::Vec2 point, std::int32_t& hint) const;
  /// Interpolated Chart::scale; outside the chart not extrapolated.
  double scale(const ChartPoint& at) const;

private:
  std::array<double, 3> weights(std::int32_t triangle, geometry::Vec2 point) const;
  std::int32_t walk(geometry::Vec2 point, std::int32_t from) const;
  std::int32_t nearest(geometry::Vec2 point) const;
  double distance_to(std::int32_t triangle, geometry::Vec2 point) const;
  double distance_to_box(std::int32_t triangle, geometry::Vec2 point) const;  // no more than that
  ChartPoint evaluate(std::int32_t triangle, geometry::Vec2 point) const;

  const Chart& _chart;
  std::vector<std::int32_t> _twins;  // opposite half-edges, -1 outside
  std::vector<double> _areas;        // twice the triangles' areas in the plane; not positive where folded
  geometry::PlaneGrid _grid;
};

/// Largest distortion that a chart may have. The advancing front meshes the plane with sizes scaled by the
/// map, which corrects scale but not stretch. An equilateral triangle stretched by 1.5 has an angle of 42
/// degrees. Chosen, not measured.
struct ChartLimits {
  double stretch = 1.5;    ///< largest ratio of singular values of the map, on all but 1 % of the area
  double scale_ratio = 8;  ///< largest ratio of scales within a chart
  double spread = 60;      ///< degrees; where normals spread less, a map up to twice over the limits will do
};

/// Maps a surface to one chart or several. Where the map folds, overlaps itself or exceeds the limits, the
/// surface is cut by a plane and both sides are tried again. Cuts are discretised once under the field and
/// their vertices are appended to `vertices`. These lie on the CAD surface; where a cut ends on a loop it
/// ends in a mesh vertex. Deterministic. Throws SurfaceError when splitting does not end.
std::vector<Chart> make_charts(const cad::Model& model, const sizing::SizeField& field,
                               const ChartSurface& surface, const ChartLimits& limits,
                               FaceVertices& vertices);

/// As make_charts() for parts of a surface that was cut. No further cut joins a pair in `joined`.
std::vector<Chart> map_parts(const cad::Model& model, const sizing::SizeField& field,
                             std::vector<ChartSurface> parts, const ChartLimits& limits,
                             JoinedVertices joined, FaceVertices& vertices);

}  // namespace aeroloom::surface
