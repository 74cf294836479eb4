#include "surface/remesh/face_remesher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace aeroloom::surface {

using geometry::Vec3;

namespace {

/// A mean ratio that needs no protection. Chosen, not measured.
constexpr double good_mean_ratio = 0.65;

}  // namespace

bool is_acceptable(const TriangleShapes& before, const TriangleShapes& after) {
  return after.facing >= std::min(before.facing, least_facing) &&
         after.mean_ratio >= std::min(before.mean_ratio, good_mean_ratio);
}

FaceRemesher::FaceRemesher(const cad::Model& model, const sizing::SizeField& field, FaceMesh& mesh)
    : _model(model), _field(field), _mesh(mesh) {
  const auto count = static_cast<std::int32_t>(mesh.points.size());
  _links.build(mesh.triangles, count);
  if (!mesh.slits.empty()) open_slits();
  _movable.assign(count, 1);
  std::fill_n(_movable.begin(), std::min(mesh.fixed, count), 0);
  for (const auto& triangle : _links.triangles) {
    for (int i = 0; i < 3; ++i) {
      if (triangle.links[i] != geometry::no_linked_edge) continue;
      _movable[triangle.vertices[geometry::next_corner(i)]] =
          _movable[triangle.vertices[geometry::previous_corner(i)]] = 0;
    }
  }
  _active.assign(count, 1);
  _next.assign(count, 0);
  measure_vertices();
  _most_vertices = bound_vertices();
}

/// Slits become borders, whose edges stay.
void FaceRemesher::open_slits() {
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(_links.triangles.size()); ++t) {
    for (int i = 0; i < 3; ++i) {
      const geometry::LinkedEdge edge = geometry::linked_edge(t, i), twin = _links.twin(edge);
      if (twin == geometry::no_linked_edge || !_mesh.is_slit(_links.origin(edge), _links.target(edge)))
        continue;
      _links.join(edge, geometry::no_linked_edge);
      _links.join(twin, geometry::no_linked_edge);
    }
  }
}

void FaceRemesher::measure_vertices() {
  _normals.resize(_mesh.points.size());
  _sizes.resize(_mesh.points.size());
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(_mesh.points.size()); ++v) {
    _sizes[v] = _field(_mesh.points[v]);
    _normals[v] = _model.face_frame(_mesh.face, _mesh.uv[v]).normal;
    if (_normals[v] == Vec3{} && _links.triangle_at[v] >= 0) _normals[v] = fan_normal(v);
  }
}

/// Normal of the triangles around a vertex, for where the surface has none.
Vec3 FaceRemesher::fan_normal(std::int32_t vertex) {
  _links.gather_fan(vertex, _fan);
  Vec3 sum;
  for (const std::int32_t t : _fan) {
    const auto& v = _links.triangles[t].vertices;
    sum += cross(_mesh.points[v[1]] - _mesh.points[v[0]], _mesh.points[v[2]] - _mesh.points[v[0]]);
  }
  return normalized(sum);
}

FaceRemesher::VertexPlace FaceRemesher::place_of(std::int32_t vertex) const {
  return {_mesh.points[vertex], _normals[vertex], _mesh.uv[vertex], _sizes[vertex]};
}

void FaceRemesher::put(std::int32_t vertex, const VertexPlace& place) {
  _mesh.points[vertex] = place.point;
  _mesh.uv[vertex] = place.uv;
  _normals[vertex] = place.normal;
  _sizes[vertex] = place.size;
}

bool FaceRemesher::project(Vec3 point, std::int32_t guess, double most_distance, VertexPlace& place) const {
  const auto found = _model.project(_mesh.face, point, _mesh.uv[guess]);
  if (!found.converged || distance(found.point, point) > most_distance) return false;
  place.point = found.point;
  place.uv = found.uv;
  place.normal = _model.face_frame(_mesh.face, found.uv).normal;
  if (place.normal == Vec3{}) place.normal = _normals[guess];
  place.size = _field(found.point);
  return true;
}

TriangleShapes FaceRemesher::shape(const std::array<VertexPlace, 3>& corners) const {
  const Vec3 u = corners[1].point - corners[0].point, v = corners[2].point - corners[0].point, w = v - u;
  const Vec3 area = cross(u, v), normal = corners[0].normal + corners[1].normal + corners[2].normal;
  const double area2 = dot(area, area), squares = dot(u, u) + dot(v, v) + dot(w, w);
  if (!(area2 > 0)) return {0, -1, std::numeric_limits<double>::infinity()};
  const double mean_ratio = 2 * std::numbers::sqrt3 * std::sqrt(area2) / squares;
  const double product = dot(area, normal), scale = area2 * dot(normal, normal);
  return {mean_ratio, scale > 0 ? product * std::abs(product) / scale : 0, 1 / mean_ratio};
}

TriangleShapes FaceRemesher::shape(std::int32_t a, std::int32_t b, std::int32_t c) const {
  return shape({place_of(a), place_of(b), place_of(c)});
}

TriangleShapes FaceRemesher::shape(std::int32_t triangle) const {
  const auto& v = _links.triangles[triangle].vertices;
  return shape(v[0], v[1], v[2]);
}

TriangleShapes FaceRemesher::shape_with(std::int32_t triangle, std::int32_t vertex,
                                        const VertexPlace& moved) const {
  const auto& v = _links.triangles[triangle].vertices;
  std::array<VertexPlace, 3> corners;
  for (int i = 0; i < 3; ++i) corners[i] = v[i] == vertex ? moved : place_of(v[i]);
  return shape(corners);
}

double FaceRemesher::edge_length(geometry::LinkedEdge edge) const {
  return distance(_mesh.points[_links.origin(edge)], _mesh.points[_links.target(edge)]);
}

void FaceRemesher::note_change(std::int32_t vertex) {
  _links.gather_fan(vertex, _fan);
  note_fan();
}

void FaceRemesher::note_fan() {
  for (const std::int32_t t : _fan) {
    for (const std::int32_t v : _links.triangles[t].vertices) _next[v] = 1;
  }
}

void FaceRemesher::end_sweep() {
  _active.swap(_next);
  _next.assign(_active.size(), 0);
}

void FaceRemesher::finish() {
  std::vector<std::int32_t> number(_mesh.points.size(), -1);
  std::int32_t count = 0;
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(number.size()); ++v) {
    if (_links.triangle_at[v] < 0 && v >= _mesh.fixed) continue;
    _mesh.points[count] = _mesh.points[v];
    _mesh.uv[count] = _mesh.uv[v];
    number[v] = count++;
  }
  _mesh.points.resize(count);
  _mesh.uv.resize(count);
  _mesh.triangles.clear();
  for (const auto& triangle : _links.triangles) {
    if (triangle.vertices[0] < 0) continue;
    const auto& v = triangle.vertices;
    _mesh.triangles.push_back({number[v[0]], number[v[1]], number[v[2]]});
  }
}

}  // namespace aeroloom::surface
