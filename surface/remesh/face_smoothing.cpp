#include "surface/remesh/face_remesher.hpp"

#include <numbers>

namespace aeroloom::surface {

using geometry::Vec3;

namespace {

/// Shorter moves, in sizes, are not worth a projection. Chosen, not measured.
constexpr double smallest_move = 0.03;
/// A projection may end so far from its start, in sizes, however short the move: the surface may curve.
constexpr double least_distance = 0.25;

}  // namespace

/// Mean, over the triangles around a vertex, of the place that makes them equilateral in the tangent plane.
Vec3 FaceRemesher::ideal_place(std::int32_t vertex) const {
  constexpr double height = std::numbers::sqrt3 / 2;
  Vec3 sum;
  for (const std::int32_t t : _fan) {
    const int k = _links.corner(t, vertex);
    const auto& v = _links.triangles[t].vertices;
    const Vec3 from = _mesh.points[v[geometry::next_corner(k)]],
               to = _mesh.points[v[geometry::previous_corner(k)]];
    sum += 0.5 * (from + to) + height * cross(_normals[vertex], to - from);
  }
  return sum / static_cast<double>(_fan.size());
}

void FaceRemesher::smooth_vertex(std::int32_t vertex) {
  if (!_links.gather_fan(vertex, _fan)) return;
  const Vec3 here = _mesh.points[vertex], offset = ideal_place(vertex) - here;
  const Vec3 move = offset - dot(offset, _normals[vertex]) * _normals[vertex];
  const double length = norm(move);
  if (!(length > smallest_move * _sizes[vertex])) return;
  VertexPlace place;
  if (!project(here + move, vertex, std::max(length, least_distance * _sizes[vertex]), place)) return;
  TriangleShapes before, after;
  for (const std::int32_t t : _fan) {
    before.add(shape(t));
    after.add(shape_with(t, vertex, place));
  }
  if (!(after.energy < before.energy) || !is_acceptable(before, after)) return;
  put(vertex, place);
  note_fan();
}

void FaceRemesher::smooth() {
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(_mesh.points.size()); ++v) {
    if (_active[v] && is_free(v) && _links.triangle_at[v] >= 0) smooth_vertex(v);
  }
}

}  // namespace aeroloom::surface
