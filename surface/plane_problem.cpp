#include "surface/plane_problem.hpp"

#include "geometry/place_text.hpp"
#include "surface/charts/chart_mesher.hpp"
#include "surface/charts/delaunay_flips.hpp"
#include "surface/charts/surface_topology.hpp"
#include "surface/front/boundary_triangulation.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::surface {
namespace {

using geometry::Vec2;
using geometry::Vec3;

/// A plane seen along one of the axes, against its normal as far as an axis can: two coordinates of each
/// point, which are not rounded.
class PlaneView {
public:
  PlaneView(const cad::Model& model, cad::FaceId face) {
    const cad::Coedge& use = model.face(face).loops.front().front();
    _uv = model.edge_uv(face, use, model.edge(use.edge).first_parameter);
    const cad::SurfaceFrame frame = model.face_frame(face, _uv);
    for (const int axis : {1, 2}) {
      if (std::abs(frame.normal[axis]) > std::abs(frame.normal[_along])) _along = axis;
    }
    _across = {(_along + 1) % 3, (_along + 2) % 3};
    if (frame.normal[_along] < 0) std::swap(_across[0], _across[1]);
    _position = frame.point[_along];
  }

  Vec2 operator()(Vec3 point) const { return {point[_across[0]], point[_across[1]]}; }
  /// Whether a point has the coordinate of an exact plane.
  bool contains(Vec3 point) const { return point[_along] == _position; }
  /// Parameters of a point of the plane, to start from.
  Vec2 uv() const { return _uv; }

private:
  int _along = 0;
  std::array<int, 2> _across{};
  double _position = 0;
  Vec2 _uv;
};

void require_plane(const cad::Model& model, cad::FaceId face, const FaceLoops& loops, const PlaneView& view) {
  if (!model.is_planar(face))
    throw std::invalid_argument(fmt::format("face '{}' is no plane", model.face(face).name));
  if (!model.is_exact_plane(face)) return;
  for (const Vec3 p : loops.points) {
    if (!view.contains(p)) {
      throw std::invalid_argument(fmt::format("({:.17g}, {:.17g}, {:.17g}) is not on the plane of face '{}'",
                                              p.x, p.y, p.z, model.face(face).name));
    }
  }
}

FaceVertices vertices_of(const cad::Model& model, cad::FaceId face, const FaceLoops& loops, Vec2 guess) {
  FaceVertices vertices{loops.points, {}, loops.vertex_keys};
  for (const Vec3 p : loops.points) {
    const cad::Projection at = model.project(face, p, guess);
    vertices.uv.push_back(at.uv);
    guess = at.uv;
  }
  return vertices;
}

/// The vertices at the ends of edges that cross; all where the loops are wrong in another way.
FaceConflict conflict_of(const cad::Model& model, cad::FaceId face, const FaceLoops& loops,
                         const front::FrontError& error) {
  std::vector<mesh::SharedVertexKey> vertices;
  std::string where;
  for (const auto& [first, second] : error.crossings()) {
    if (vertices.empty()) {
      const Vec3 at = loops.points[loops.edges[first][0]];
      where = fmt::format(" near {}", geometry::place_text(at));
    }
    for (const std::int32_t e : {first, second}) {
      for (const std::int32_t v : loops.edges[e]) vertices.push_back(loops.vertex_keys[v]);
    }
  }
  if (vertices.empty()) vertices = loops.vertex_keys;
  return {fmt::format("face '{}' (patch '{}'): its boundary crosses or touches itself{}: {}",
                      model.face(face).name, model.patches()[model.face(face).patch], where, error.what()),
          {},
          std::move(vertices)};
}

/// The triangles inside, loop edges that have the face on both sides cut open.
ChartSurface chart_surface_of(const front::Delaunay& plane, cad::FaceId face, const FaceVertices& vertices) {
  ChartSurface whole;
  whole.face = face;
  whole.points = vertices.points;
  for (std::size_t v = 0; v < vertices.points.size(); ++v)
    whole.mesh_vertex.push_back(static_cast<std::int32_t>(v));
  std::vector<char> on_loop;  // per half-edge
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(plane.mesh.triangles.size()); ++t) {
    const geometry::LinkedTriangle& triangle = plane.mesh.triangles[t];
    if (front::state_of(triangle) == front::TriangleState::outside) continue;
    const auto& [a, b, c] = triangle.vertices;
    whole.triangles.push_back(triangle.vertices);
    whole.corner_uv.push_back({vertices.uv[a], vertices.uv[b], vertices.uv[c]});
    for (int i = 0; i < 3; ++i)
      on_loop.push_back(plane.mesh.is_fixed(geometry::linked_edge(t, geometry::previous_corner(i))) ? 1 : 0);
  }
  auto twins = geometry::match_half_edges(whole.triangles);
  for (std::size_t h = 0; h < twins.size(); ++h) {
    if (on_loop[h]) twins[h] = -1;
  }
  return separate_parts(whole, twins, std::vector<std::int32_t>(whole.triangles.size(), 0), 1).front();
}

}  // namespace

PieceProblem problem_of_plane(const cad::Model& model, cad::FaceId face, const FaceLoops& loops,
                              const sizing::SizeField& field) {
  const PlaneView view(model, face);
  require_plane(model, face, loops, view);
  front::FrontInput boundary{{}, loops.edges};
  for (const Vec3 p : loops.points) boundary.points.push_back(view(p));
  PieceProblem problem;
  problem.vertices = vertices_of(model, face, loops, view.uv());
  try {
    problem.surface = chart_surface_of(front::triangulate_region(boundary), face, problem.vertices);
  } catch (const front::FrontError& error) {
    throw conflict_of(model, face, loops, error);
  }
  flip_to_delaunay(problem.surface);
  problem.load = predict_triangles(problem.surface, field);
  return problem;
}

}  // namespace aeroloom::surface
