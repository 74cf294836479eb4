#include "surface/face_mesher.hpp"

#include "surface/chart.hpp"
#include "surface/front.hpp"
#include "surface/remesh.hpp"
#include "surface/support.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// The loops of a chart as the front wants them, and where its vertices are known from.
struct ChartBoundary {
  FrontInput input;
  std::vector<std::int32_t> face_vertex;  // per boundary point: vertex of the face's mesh
};

/// Per boundary point, the one to use in its place. Where loops touch in a vertex, the chart has a point for
/// each passage; those that the map puts on one spot are one vertex of the front.
std::vector<std::int32_t> join_passages(const ChartBoundary& boundary) {
  constexpr double one_spot = 1e-6;  // of the shortest edge there
  const auto& points = boundary.input.points;
  const auto count = static_cast<std::int32_t>(points.size());
  std::vector<double> reach(count, std::numeric_limits<double>::max());
  for (const auto& [a, b] : boundary.input.edges) {
    const Vec2 edge = points[b] - points[a];
    const double length = std::hypot(edge.x, edge.y);
    for (const std::int32_t end : {a, b}) reach[end] = std::min(reach[end], one_spot * length);
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
    if (std::hypot(apart.x, apart.y) <= std::min(reach[first], reach[next])) target[next] = first;
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
  std::vector<std::int32_t> number(chart.support.points.size(), -1);
  const auto point_of = [&](std::int32_t support_point) {
    if (number[support_point] < 0) {
      number[support_point] = static_cast<std::int32_t>(boundary.input.points.size());
      boundary.input.points.push_back(chart.plane[support_point]);
      boundary.face_vertex.push_back(chart.support.mesh_vertex[support_point]);
    }
    return number[support_point];
  };
  for (const auto& [from, to] : chart.support.loop_edges) {
    const std::int32_t first = point_of(from);
    boundary.input.edges.push_back({first, point_of(to)});
  }
  use_joined_points(join_passages(boundary), boundary);
  return boundary;
}

/// Where loops cross, both curves are too coarse for the gap between them: half their length is asked for.
FaceConflict conflict_of(const geometry::Model& model, geometry::FaceId face, const FrontError& error,
                         const ChartBoundary& boundary, const FaceVertices& vertices) {
  std::vector<sizing::SizeSource> remedy;
  for (const CrossingEdges& crossing : error.crossings()) {
    for (const std::int32_t e : {crossing.first, crossing.second}) {
      const Vec3 a = vertices.points[boundary.face_vertex[boundary.input.edges[e][0]]];
      const Vec3 b = vertices.points[boundary.face_vertex[boundary.input.edges[e][1]]];
      if (distance(a, b) > 0) remedy.push_back({0.5 * (a + b), 0.5 * distance(a, b)});
    }
  }
  std::string where =
      remedy.empty() ? std::string()
                     : fmt::format(" near ({:.6g}, {:.6g}, {:.6g}), size {:.4g} there", remedy[0].point.x,
                                   remedy[0].point.y, remedy[0].point.z, 2 * remedy[0].size);
  return {fmt::format("face '{}' (patch '{}'): its boundary curves cross or touch{}: {}",
                      model.face(face).name, model.patches()[model.face(face).patch], where, error.what()),
          std::move(remedy)};
}

/// Appends the triangles of one chart to the mesh of the face. Points the front placed return to the CAD
/// surface.
void fill_chart(const geometry::Model& model, const sizing::SizeField& field, const Chart& chart,
                const FaceVertices& vertices, FaceMesh& mesh) {
  const ChartBoundary boundary = boundary_of(chart);
  const ChartLocator locator(chart);
  const auto size = [&](Vec2 point, std::int32_t& hint) {
    const ChartPoint at = locator.locate(point, hint);
    return field(at.point) * locator.scale(at);
  };
  FrontResult filled;
  try {
    filled = fill_front(boundary.input, size);
  } catch (const FrontError& error) {
    throw conflict_of(model, chart.support.face, error, boundary, vertices);
  }
  std::vector<std::int32_t> number = boundary.face_vertex;
  number.reserve(filled.points.size());
  std::int32_t hint = 0;
  for (std::size_t i = number.size(); i < filled.points.size(); ++i) {
    const ChartPoint at = locator.locate(filled.points[i], hint);
    const geometry::Projection on_surface = model.project(chart.support.face, at.point, at.uv);
    number.push_back(static_cast<std::int32_t>(mesh.points.size()));
    mesh.uv.push_back(on_surface.converged ? on_surface.uv : at.uv);
    mesh.points.push_back(on_surface.converged ? on_surface.point
                                               : model.face_point(chart.support.face, at.uv));
  }
  for (const auto& t : filled.triangles) mesh.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
}

/// Charts take part with every triangle; the vertices known beforehand come first, those on CAD curves stay
/// fixed.
FaceMesh fill_charts(const geometry::Model& model, const sizing::SizeField& field,
                     const std::vector<Chart>& charts, const FaceVertices& vertices, geometry::FaceId face) {
  FaceMesh mesh;
  mesh.face = face;
  mesh.points = vertices.points;
  mesh.uv = vertices.uv;
  mesh.fixed = vertices.curve_count;
  for (const Chart& chart : charts) fill_chart(model, field, chart, vertices, mesh);
  return mesh;
}

void classify_curve_vertex(const geometry::Model& model, const CurveMesh& curves, CurveVertex vertex,
                           mesh::Piece& piece) {
  const bool on_vertex = vertex < model.vertex_count();
  piece.vertex_dimension.push_back(on_vertex ? 0 : 1);
  piece.vertex_entity.push_back(on_vertex ? vertex : curves.edge_of(model, vertex));
}

mesh::Piece piece_of(const geometry::Model& model, const CurveMesh& curves, const FaceVertices& vertices,
                     const FaceMesh& mesh) {
  mesh::Piece piece;
  piece.id = mesh.face;
  piece.kind = mesh::CellKind::triangle;
  piece.coordinates.reserve(3 * mesh.points.size());
  for (const Vec3& p : mesh.points) piece.coordinates.insert(piece.coordinates.end(), {p.x, p.y, p.z});
  for (const auto& t : mesh.triangles) piece.cells.insert(piece.cells.end(), t.begin(), t.end());
  for (std::int32_t v = 0; v < vertices.curve_count; ++v) {
    classify_curve_vertex(model, curves, vertices.curve_vertex[v], piece);
    piece.shared_vertices.push_back(v);
    piece.shared_tokens.push_back(static_cast<mesh::SharedToken>(vertices.curve_vertex[v]));
  }
  piece.vertex_dimension.resize(mesh.points.size(), 2);
  piece.vertex_entity.resize(mesh.points.size(), mesh.face);
  piece.triangle_face.assign(mesh.triangles.size(), mesh.face);
  piece.triangle_patch.assign(mesh.triangles.size(), model.face(mesh.face).patch);
  return piece;
}

/// Twice the area over the perimeter: about the width of a strip, whatever its length.
double mean_width(const geometry::Model& model, geometry::FaceId face) {
  constexpr int intervals = 16;  // of an edge; its length is needed to a few percent
  double perimeter = 0;
  for (const auto& loop : model.face(face).loops) {
    for (const geometry::EdgeUse& use : loop) {
      const geometry::Edge& edge = model.edge(use.edge);
      if (edge.degenerate) continue;
      Vec3 last = model.edge_point(use.edge, edge.first_parameter);
      for (int i = 1; i <= intervals; ++i) {
        const double along = static_cast<double>(i) / intervals;
        const Vec3 next = model.edge_point(
            use.edge, edge.first_parameter + along * (edge.last_parameter - edge.first_parameter));
        perimeter += distance(last, next);
        last = next;
      }
    }
  }
  return perimeter > 0 ? 2 * model.face_area(face) / perimeter : 0;
}

}  // namespace

geometry::Facets support_facets(const geometry::Model& model, geometry::FaceId face,
                                const SurfaceOptions& options) {
  // Facets may leave the surface by a small part of the model, and of the face's own width: a curved strip
  // must not fold over itself.
  constexpr double part_of_model = 1e-3, part_of_width = 0.03, least_part_of_model = 1e-6;
  const double scale = model.is_far_field(face) ? model.bounds().diagonal() : model.body_bounds().diagonal();
  const double deflection =
      std::clamp(part_of_width * mean_width(model, face), least_part_of_model * scale, part_of_model * scale);
  return model.facets(face, deflection, options.support_angle * std::numbers::pi / 180);
}

mesh::Piece mesh_face(const geometry::Model& model, geometry::FaceId face, const CurveMesh& curves,
                      const sizing::SizeField& field, const SurfaceOptions& options) {
  FaceVertices vertices;
  Support support = build_support(model, face, curves, support_facets(model, face, options), vertices);
  const ChartLimits limits{.spread = options.chart_spread};
  const std::vector<Chart> charts = make_charts(model, field, std::move(support), limits, vertices);
  FaceMesh mesh = fill_charts(model, field, charts, vertices, face);
  remesh_interior(model, field, options.smoothing_sweeps, mesh);
  return piece_of(model, curves, vertices, mesh);
}

}  // namespace aeroloom::surface
