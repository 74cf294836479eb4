#include "surface/charts/chart_mesher.hpp"

#include "geometry/place_text.hpp"
#include "surface/charts/chart.hpp"
#include "surface/front/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;

/// The loops of a chart as the front wants them, and where its vertices are known from.
struct ChartBoundary {
  front::FrontInput input;
  std::vector<std::int32_t> face_vertex;  // per boundary point: vertex of the face's mesh
};

/// Per boundary point, the one to use in its place. Where loops touch in a vertex, the chart has a point for
/// each coedge; those that the map puts on one spot are one vertex of the front.
std::vector<std::int32_t> join_coedges(const ChartBoundary& boundary) {
  constexpr double one_spot = 1e-6;  // of the shortest edge there; what rounding of the map leaves; chosen
  const auto& points = boundary.input.points;
  const auto count = static_cast<std::int32_t>(points.size());
  std::vector<double> radius(count, std::numeric_limits<double>::max());
  for (const auto& [a, b] : boundary.input.edges) {
    const Vec2 edge = points[b] - points[a];
    const double length = std::hypot(edge.x, edge.y);
    for (const std::int32_t end : {a, b}) radius[end] = std::min(radius[end], one_spot * length);
  }
  std::vector<std::int32_t> order(count), target(count);
  std::iota(order.begin(), order.end(), 0);
  std::iota(target.begin(), target.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    return boundary.face_vertex[i] < boundary.face_vertex[j];
  });
  for (std::int32_t i = 1; i < count; ++i) {
    const std::int32_t first = target[order[i - 1]], next = order[i];
    if (boundary.face_vertex[first] != boundary.face_vertex[next]) continue;
    const Vec2 apart = points[next] - points[first];
    if (std::hypot(apart.x, apart.y) <= std::min(radius[first], radius[next])) target[next] = first;
  }
  return target;
}

/// Redirects the edges to the points they use in the end, and drops the others.
void use_joined_points(const std::vector<std::int32_t>& target, ChartBoundary& boundary) {
  std::vector<std::int32_t> number(target.size());
  std::int32_t kept = 0;
  for (std::size_t i = 0; i < target.size(); ++i) {
    if (target[i] != static_cast<std::int32_t>(i)) continue;
    boundary.input.points[kept] = boundary.input.points[i];
    boundary.face_vertex[kept] = boundary.face_vertex[i];
    number[i] = kept++;
  }
  boundary.input.points.resize(kept);
  boundary.face_vertex.resize(kept);
  for (auto& edge : boundary.input.edges) edge = {number[target[edge[0]]], number[target[edge[1]]]};
}

ChartBoundary boundary_of(const Chart& chart) {
  ChartBoundary boundary;
  std::vector<std::int32_t> number(chart.surface.points.size(), -1);
  const auto point_of = [&](std::int32_t surface_point) {
    if (number[surface_point] < 0) {
      number[surface_point] = static_cast<std::int32_t>(boundary.input.points.size());
      boundary.input.points.push_back(chart.plane[surface_point]);
      boundary.face_vertex.push_back(chart.surface.mesh_vertex[surface_point]);
    }
    return number[surface_point];
  };
  for (const auto& [from, to] : chart.surface.loop_edges) {
    const std::int32_t first = point_of(from);
    boundary.input.edges.push_back({first, point_of(to)});
  }
  use_joined_points(join_coedges(boundary), boundary);
  return boundary;
}

/// Where loops cross, both curves are too coarse for the gap between them: half their length is field_size
/// for.
FaceConflict conflict_of(const cad::Model& model, cad::FaceId face, const front::FrontError& error,
                         const ChartBoundary& boundary, const FaceVertices& vertices) {
  std::vector<sizing::SizeSource> remedy;
  std::vector<mesh::SharedVertexKey> named;
  for (const front::CrossingEdges& crossing : error.crossings()) {
    for (const std::int32_t e : {crossing.first, crossing.second}) {
      for (const std::int32_t end : boundary.input.edges[e]) {
        const std::int32_t v = boundary.face_vertex[end];
        if (v < vertices.border_count()) named.push_back(vertices.vertex_keys[v]);
      }
      const geometry::Vec3 a = vertices.points[boundary.face_vertex[boundary.input.edges[e][0]]];
      const geometry::Vec3 b = vertices.points[boundary.face_vertex[boundary.input.edges[e][1]]];
      if (distance(a, b) > 0) remedy.push_back({0.5 * (a + b), 0.5 * distance(a, b)});
    }
  }
  std::string where = remedy.empty() ? std::string()
                                     : fmt::format(" near {}, size {:.4g} there",
                                                   geometry::place_text(remedy[0].point), 2 * remedy[0].size);
  return {fmt::format("face '{}' (patch '{}'): its boundary curves cross or touch{}: {}",
                      model.face(face).name, model.patches()[model.face(face).patch], where, error.what()),
          std::move(remedy), std::move(named)};
}

/// Per point of the chart, the length over which the surface turns by an angle; infinite
/// where it is flat.
std::vector<double> turning_lengths(const cad::Model& model, const ChartSurface& surface, double angle) {
  std::vector<double> lengths(surface.points.size(), -1);
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      double& length = lengths[surface.triangles[t][i]];
      if (length >= 0) continue;
      const auto curvatures =
          model.face_curvatures(surface.face, model.wrap(surface.face, surface.corner_uv[t][i]));
      const double bend = curvatures.defined ? std::abs(curvatures.largest) : 0;
      length = bend > 0 ? angle / bend : std::numeric_limits<double>::infinity();
    }
  }
  return lengths;
}

/// Wanted edge lengths in a chart.
class ChartSizes {
public:
  ChartSizes(const cad::Model& model, const sizing::SizeField& field, const Chart& chart,
             const ChartLocator& locator, const ChartMeshing& options)
      : _field(field), _chart(chart), _locator(locator), _least_fraction(options.least_fraction) {
    if (options.largest_turn > 0 && !model.is_planar(chart.surface.face))
      _turning = turning_lengths(model, chart.surface, options.largest_turn);
  }

  double operator()(Vec2 point, std::int32_t& hint) const {
    const ChartPoint at = _locator.locate(point, hint);
    const double field_size = _field(at.point);
    double size = field_size;
    if (!_turning.empty()) {
      for (const std::int32_t corner : _chart.surface.triangles[at.triangle])
        size = std::min(size, _turning[corner]);
      size = std::max(size, _least_fraction * field_size);
    }
    return size * _locator.scale(at);
  }

private:
  const sizing::SizeField& _field;
  const Chart& _chart;
  const ChartLocator& _locator;
  double _least_fraction;
  std::vector<double> _turning;  // per point of the chart; empty: any
};

/// Appends the triangles of one chart to the mesh of the piece. Points the front placed return to the CAD
/// surface.
void fill_chart(const cad::Model& model, const sizing::SizeField& field, const Chart& chart,
                const FaceVertices& vertices, const ChartMeshing& options, FaceMesh& mesh) {
  const cad::FaceId face = chart.surface.face;
  const ChartBoundary boundary = boundary_of(chart);
  const ChartLocator locator(chart);
  const ChartSizes sizes(model, field, chart, locator, options);
  front::FrontResult filled;
  try {
    filled = front::fill_front(boundary.input,
                               [&sizes](Vec2 point, std::int32_t& hint) { return sizes(point, hint); });
  } catch (const front::FrontError& error) {
    throw conflict_of(model, face, error, boundary, vertices);
  }
  std::vector<std::int32_t> number = boundary.face_vertex;
  number.reserve(filled.points.size());
  std::int32_t hint = 0;
  for (std::size_t i = number.size(); i < filled.points.size(); ++i) {
    const ChartPoint at = locator.locate(filled.points[i], hint);
    const Vec2 guess = model.wrap(face, at.uv);
    const cad::Projection on_surface = model.project(face, at.point, guess);
    number.push_back(static_cast<std::int32_t>(mesh.points.size()));
    mesh.uv.push_back(on_surface.converged ? on_surface.uv : guess);
    mesh.points.push_back(on_surface.converged ? on_surface.point : model.face_point(face, guess));
  }
  for (const auto& t : filled.triangles) mesh.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
}

}  // namespace

FaceMesh mesh_charts(const cad::Model& model, const sizing::SizeField& field, const ChartSurface& surface,
                     FaceVertices vertices, const ChartMeshing& options) {
  FaceMesh mesh;
  mesh.face = surface.face;
  mesh.fixed = vertices.border_count();
  const std::vector<Chart> charts =
      make_charts(model, field, surface, {.spread = options.chart_spread}, vertices);
  mesh.points = vertices.points;
  mesh.uv = vertices.uv;
  for (const Chart& chart : charts) fill_chart(model, field, chart, vertices, options, mesh);
  remesh_interior(model, field, options.remeshing, mesh);
  return mesh;
}

}  // namespace aeroloom::surface
