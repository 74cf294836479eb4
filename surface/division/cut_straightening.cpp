#include "surface/division/cut_straightening.hpp"

#include "geometry/angle.hpp"
#include "surface/remesh/face_remesher.hpp"

#include <algorithm>
#include <numbers>

namespace aeroloom::surface {

using geometry::Vec3;

namespace {

constexpr int sweeps = 12;  // a kink spreads over as many edges; chosen, not measured
/// A vertex goes so far towards the middle of its neighbours: less than all, as these move too.
constexpr double relaxation = 0.7;
/// Triangles may be distorted to this mean ratio: they carry the pieces, they are not the mesh.
constexpr double least_mean_ratio = 0.4;
/// Angles below this one are protected, in parts of the smallest angle allowed. Chosen, not measured.
constexpr double margin = 1.2;

}  // namespace

void FaceRemesher::gather_borders(std::int32_t vertex, const std::vector<std::int32_t>& part) {
  _borders.clear();
  const bool closed = _links.gather_fan(vertex, _fan);
  const std::size_t count = _fan.size();
  for (std::size_t i = 0; i < count; ++i) {
    const int k = _links.corner(_fan[i], vertex);
    const std::size_t before = i > 0 ? i - 1 : count - 1;
    const bool first_of_open = i == 0 && !closed;
    if (first_of_open || part[_fan[before]] != part[_fan[i]])
      _borders.push_back(_links.triangles[_fan[i]].vertices[geometry::next_corner(k)]);
    if (i + 1 == count && !closed)
      _borders.push_back(_links.triangles[_fan[i]].vertices[geometry::previous_corner(k)]);
  }
}

double FaceRemesher::smallest_border_angle(std::int32_t vertex, const std::vector<std::int32_t>& part) {
  gather_borders(vertex, part);
  double smallest = std::numbers::pi;
  for (std::size_t i = 0; i < _borders.size(); ++i) {
    for (std::size_t j = i + 1; j < _borders.size(); ++j) {
      const Vec3 u = _mesh.points[_borders[i]] - _mesh.points[vertex];
      const Vec3 v = _mesh.points[_borders[j]] - _mesh.points[vertex];
      smallest = std::min(smallest, angle_between(u, v));
    }
  }
  return smallest * 180 / std::numbers::pi;
}

bool FaceRemesher::straighten_vertex(std::int32_t vertex, const std::vector<std::int32_t>& part,
                                     double smallest_angle) {
  gather_borders(vertex, part);
  if (_borders.empty()) return false;
  const VertexPlace before_move = place_of(vertex);
  const std::vector<std::int32_t> ends = _borders;
  Vec3 sum;
  for (const std::int32_t end : ends) sum += _mesh.points[end];
  const Vec3 offset = sum / static_cast<double>(ends.size()) - before_move.point;
  const Vec3 move = relaxation * (offset - dot(offset, _normals[vertex]) * _normals[vertex]);
  VertexPlace place;
  if (!project(before_move.point + move, vertex, norm(move) + 0.5 * _sizes[vertex], place)) return true;
  TriangleShapes before, after;
  for (const std::int32_t t : _fan) {
    before.add(shape(t));
    after.add(shape_with(t, vertex, place));
  }
  const bool is_sound = after.facing >= std::min(before.facing, 0.5) &&
                        after.mean_ratio >= std::min(before.mean_ratio, least_mean_ratio);
  if (!is_sound) return true;
  const auto least_around = [&] {
    double least = smallest_border_angle(vertex, part);
    for (const std::int32_t end : ends) least = std::min(least, smallest_border_angle(end, part));
    return least;
  };
  const double angle_before = least_around();
  put(vertex, place);
  if (least_around() < std::min(angle_before, margin * smallest_angle)) put(vertex, before_move);
  return true;
}

void FaceRemesher::straighten(const std::vector<std::int32_t>& part, double smallest_angle) {
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(_mesh.points.size()); ++v) {
    if (!is_free(v) || _links.triangle_at[v] < 0) continue;
    if (!straighten_vertex(v, part, smallest_angle)) smooth_vertex(v);
  }
}

void straighten_cuts(const cad::Model& model, const sizing::SizeField& field,
                     const std::vector<std::int32_t>& part, double smallest_angle, FaceMesh& mesh) {
  FaceRemesher remesher(model, field, mesh);
  for (int sweep = 0; sweep < sweeps; ++sweep) remesher.straighten(part, smallest_angle);
  remesher.finish();
}

}  // namespace aeroloom::surface
