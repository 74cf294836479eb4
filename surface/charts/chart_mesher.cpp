#include "surface/charts/chart_mesher.hpp"

#include "geometry/place_text.hpp"
#include "surface/charts/chart.hpp"
#include "surface/charts/chart_division.hpp"
#include "surface/charts/surface_topology.hpp"
#include "surface/front/front.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;

/// A chart that folds is divided in two, and its parts again, so often at most: 256 parts (docs/bounds.md).
constexpr int most_divisions = 8;

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

/// The middle of the triangle of the surface on a loop edge.
geometry::Vec3 place_of_triangle(const ChartSurface& surface, std::int32_t loop_edge) {
  const std::int32_t from = surface.loop_edges[loop_edge][0];
  const std::vector<geometry::HalfEdge> twins = geometry::match_half_edges(surface.triangles);
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(twins.size()); ++h) {
    if (twins[h] >= 0 || start_of(surface, h) != from) continue;
    const auto& [a, b, c] = surface.triangles[h / 3];
    return (surface.points[a] + surface.points[b] + surface.points[c]) / 3;
  }
  return surface.points[from];
}

/// Names the triangles where the border meets itself.
std::string reason_of(const ChartSurface& surface, const front::FrontError& error) {
  if (error.crossings().empty()) return error.what();
  const front::CrossingEdges& first = error.crossings().front();
  return fmt::format("{} pair(s) of edges meet, the first of them on the triangles around {} and {}",
                     error.crossings().size(), geometry::place_text(place_of_triangle(surface, first.first)),
                     geometry::place_text(place_of_triangle(surface, first.second)));
}

/// The loop edges of a chart that are too long: those that cross. Where none does, the chords of all have
/// left the face on one side of the other: a border that bends is nearer to the next one than its chord.
std::vector<std::int32_t> edges_at_fault(const front::FrontError& error, const ChartBoundary& boundary) {
  std::vector<std::int32_t> edges;
  for (const front::CrossingEdges& crossing : error.crossings()) {
    edges.push_back(crossing.first);
    edges.push_back(crossing.second);
  }
  if (edges.empty()) {
    edges.resize(boundary.input.edges.size());
    std::iota(edges.begin(), edges.end(), 0);
  }
  return edges;
}

/// Where loops cross, both curves are too coarse for the gap between them: half their length is field_size
/// for.
FaceConflict conflict_of(const cad::Model& model, const ChartSurface& surface, const front::FrontError& error,
                         const ChartBoundary& boundary, const FaceVertices& vertices) {
  std::vector<sizing::SizeSource> remedy;
  std::vector<mesh::SharedVertexKey> named;
  for (const std::int32_t e : edges_at_fault(error, boundary)) {
    for (const std::int32_t end : boundary.input.edges[e]) {
      const std::int32_t v = boundary.face_vertex[end];
      if (v < vertices.border_count()) named.push_back(vertices.vertex_keys[v]);
    }
    const geometry::Vec3 a = vertices.points[boundary.face_vertex[boundary.input.edges[e][0]]];
    const geometry::Vec3 b = vertices.points[boundary.face_vertex[boundary.input.edges[e][1]]];
    if (distance(a, b) > 0) remedy.push_back({0.5 * (a + b), 0.5 * distance(a, b)});
  }
  std::string where = remedy.empty() ? std::string()
                                     : fmt::format(" near {}, size {:.4g} there",
                                                   geometry::place_text(remedy[0].point), 2 * remedy[0].size);
  const cad::FaceId face = surface.face;
  return {
      fmt::format("face '{}' (patch '{}'): its boundary curves cross or touch{}: {}", model.face(face).name,
                  model.patches()[model.face(face).patch], where, reason_of(surface, error)),
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

/// What the front made of charts, until all cuts between them are known.
struct ChartFilling {
  std::vector<geometry::Vec3> points;
  std::vector<Vec2> uv;
  std::vector<std::array<std::int32_t, 3>> triangles;  // of vertices of the face, or -1 - an own point
};

/// Fills charts one by one, and divides those that fold.
class ChartFiller {
public:
  ChartFiller(const cad::Model& model, const sizing::SizeField& field, const ChartMeshing& options,
              FaceVertices& vertices)
      : _model(model), _field(field), _options(options), _vertices(vertices) {}

  void fill_all(const std::vector<Chart>& charts) {
    _charts = &charts;
    for (const Chart& chart : charts) fill(chart, 0);
  }

  /// Appends all to the mesh of the piece, behind the vertices of the face.
  void append_to(FaceMesh& mesh) const {
    const auto first = static_cast<std::int32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), _filling.points.begin(), _filling.points.end());
    mesh.uv.insert(mesh.uv.end(), _filling.uv.begin(), _filling.uv.end());
    for (auto triangle : _filling.triangles) {
      for (std::int32_t& v : triangle) v = v < 0 ? first - 1 - v : v;
      mesh.triangles.push_back(triangle);
    }
  }

private:
  void fill(const Chart& chart, int divisions);
  bool divide(const Chart& chart, const front::FrontError& error, int divisions);
  void add(const Chart& chart, const ChartLocator& locator, const ChartBoundary& boundary,
           const front::FrontResult& filled);

  const cad::Model& _model;
  const sizing::SizeField& _field;
  const ChartMeshing& _options;
  FaceVertices& _vertices;
  const std::vector<Chart>* _charts = nullptr;
  std::optional<JoinedVertices> _joined;  // by edges of charts; made for the first that folds
  ChartFilling _filling;
};

void ChartFiller::fill(const Chart& chart, int divisions) {
  const ChartBoundary boundary = boundary_of(chart);
  const ChartLocator locator(chart);
  const ChartSizes sizes(_model, _field, chart, locator, _options);
  try {
    const front::FrontResult filled = front::fill_front(
        boundary.input, [&sizes](Vec2 point, std::int32_t& hint) { return sizes(point, hint); });
    add(chart, locator, boundary, filled);
  } catch (const front::FrontError& error) {
    if (!divide(chart, error, divisions))
      throw conflict_of(_model, chart.surface, error, boundary, _vertices);
  }
}

/// Whether a chart that the front cannot fill was divided, and its parts filled.
bool ChartFiller::divide(const Chart& chart, const front::FrontError& error, int divisions) {
  if (!_options.divides_folds || divisions >= most_divisions || _model.is_planar(chart.surface.face))
    return false;
  std::vector<std::array<std::int32_t, 2>> chords;
  for (const front::CrossingEdges& crossing : error.crossings())
    chords.push_back({crossing.first, crossing.second});
  const std::optional<ChartFold> fold = find_fold(chart, chords);
  if (!fold) return false;
  if (!_joined) {
    _joined.emplace();
    for (const Chart& each : *_charts) _joined->merge(joined_vertices(each.surface));
  }
  const std::vector<Chart> parts =
      divide_chart(_model, _field, {chart, *fold}, {.spread = _options.chart_spread}, *_joined, _vertices);
  for (const Chart& part : parts) _joined->merge(joined_vertices(part.surface));
  for (const Chart& part : parts) fill(part, divisions + 1);
  return !parts.empty();
}

/// Points the front placed return to the CAD surface.
void ChartFiller::add(const Chart& chart, const ChartLocator& locator, const ChartBoundary& boundary,
                      const front::FrontResult& filled) {
  const cad::FaceId face = chart.surface.face;
  std::vector<std::int32_t> number = boundary.face_vertex;
  number.reserve(filled.points.size());
  std::int32_t hint = 0;
  for (std::size_t i = number.size(); i < filled.points.size(); ++i) {
    const ChartPoint at = locator.locate(filled.points[i], hint);
    const Vec2 guess = _model.wrap(face, at.uv);
    const cad::Projection on_surface = _model.project(face, at.point, guess);
    number.push_back(-1 - static_cast<std::int32_t>(_filling.points.size()));
    _filling.uv.push_back(on_surface.converged ? on_surface.uv : guess);
    _filling.points.push_back(on_surface.converged ? on_surface.point : _model.face_point(face, guess));
  }
  for (const auto& t : filled.triangles)
    _filling.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
}

}  // namespace

FaceMesh mesh_charts(const cad::Model& model, const sizing::SizeField& field, const ChartSurface& surface,
                     FaceVertices vertices, const ChartMeshing& options) {
  FaceMesh mesh;
  mesh.face = surface.face;
  mesh.fixed = vertices.border_count();
  mesh.slits = slits_of(surface);
  const std::vector<Chart> charts =
      make_charts(model, field, surface, {.spread = options.chart_spread}, vertices);
  ChartFiller filler(model, field, options, vertices);
  filler.fill_all(charts);
  mesh.points = vertices.points;
  mesh.uv = vertices.uv;
  filler.append_to(mesh);
  remesh_interior(model, field, options.remeshing, mesh);
  return mesh;
}

}  // namespace aeroloom::surface
