/// Low-distortion charts of a chart surface: least squares conformal maps (Levy, Petitjean, Ray and Maillot,
/// ACM Trans. Graph. 21, 2002, doi:10.1145/566654.566590), and the splitting of what one chart cannot carry
/// (Remacle et al., Int. J. Numer. Meth. Engng 83, 2010, doi:10.1002/nme.2824; Marchandise et al., J. Comput.
/// Phys. 234, 2013, doi:10.1016/j.jcp.2012.09.012).
#pragma once

#include "cad/model/model.hpp"
#include "geometry/plane_grid.hpp"
#include "sizing/field/size_field.hpp"
#include "surface/charts/chart_surface.hpp"

#include <vector>

namespace aeroloom::surface {

/// A chart surface with a one-to-one map of it to the plane.
struct Chart {
  ChartSurface surface;
  std::vector<geometry::Vec2> plane;  ///< per chart surface point
  std::vector<double> scale;          ///< per chart surface point: chart length over length in space
};

/// Where a point of the chart lies on the chart surface.
struct ChartPoint {
  std::int32_t triangle = 0;
  std::array<double, 3>
      weights{};         ///< barycentric; negative ones where the point lies beyond the chart surface's edge
  geometry::Vec3 point;  ///< on the facets
  geometry::Vec2 uv;     ///< interpolated
};

/// Finds points in a chart: by walking from a hint, then in a uniform grid; outside, the nearest triangle.
/// Triangles that are folded in the plane are never found.
class ChartLocator {
public:
  /// The chart must outlive the locator.
  explicit ChartLocator(const Chart& chart);
  /// `hint` is a triangle to start from (any value is allowed) and receives the one found. Beyond the
  /// chart surface's edge, the point is extrapolated from the nearest triangle and uv are those of its
  /// nearest point.
  ChartPoint locate(geometry::Vec2 point, std::int32_t& hint) const;
  /// Interpolated Chart::scale; that of the nearest point of the triangle across the edge.
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

/// Bounds on how a chart may distort triangles. The front meshes the plane with sizes that the map has
/// scaled: stretch it cannot undo, and an equilateral triangle that is stretched by 1.5 has angles of 42
/// degrees and more. Chosen, not measured.
struct ChartLimits {
  double stretch = 1.5;    ///< largest ratio of singular values of the map, on all but 1 % of the area
  double scale_ratio = 8;  ///< largest ratio of scales within a chart
  double spread = 60;  ///< degrees; patches are split down to this spread of normals when nothing else helps
};

/// Maps a chart surface to one chart or several: where the map folds, overlaps itself or exceeds the limits,
/// the chart surface is cut by a plane and both sides are tried again. Cuts are discretised once under the
/// field, their vertices lie on the CAD surface, are appended to `vertices`, and join mesh vertices of the
/// loops where they end. Deterministic. Throws SurfaceError when splitting does not end.
std::vector<Chart> make_charts(const cad::Model& model, const sizing::SizeField& field,
                               const ChartSurface& surface, const ChartLimits& limits,
                               FaceVertices& vertices);

}  // namespace aeroloom::surface
