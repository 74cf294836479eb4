#include "improve/void_filling.hpp"

#include "mesh/quality.hpp"

#include <algorithm>
#include <limits>

namespace aeroloom::improve {
namespace {

constexpr std::size_t most_tets = 60;
/// Radius of the sphere over the shortest edge: 0.65 in a body-centred lattice, 0.87 in the corners of the
/// cube that a missing point leaves.
constexpr double large_sphere = 0.8;
/// Over the mean edge: larger spheres belong to slivers and reach far.
constexpr double largest_sphere = 1.1;
/// Over the mean edge of the cavity: new edges are no shorter.
constexpr double least_edge = 0.62;
constexpr double least_gain = 0.02;  // of the mean ratio on average

struct Sphere {
  Vec3 center;
  double squared_radius = -1;
};

/// The circumscribed sphere, relative accuracy of a few roundings over the quality.
Sphere circumsphere(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double six = dot(u, cross(v, w));
  if (six == 0) return {};
  const Vec3 offset =
      (0.5 / six) * (dot(u, u) * cross(v, w) + dot(v, v) * cross(w, u) + dot(w, w) * cross(u, v));
  return {a + offset, dot(offset, offset)};
}

double shortest_edge(const std::array<Vec3, 4>& p) {
  double least = std::numeric_limits<double>::max();
  for (const auto& [i, k] : mesh::tetrahedron_edges) least = std::min(least, distance(p[i], p[k]));
  return least;
}

}  // namespace

bool VoidFilling::is_candidate(const TetMesh& mesh, LocalIndex t) {
  const Corners& c = mesh.corners(t);
  if (std::any_of(c.begin(), c.end(), [&](LocalIndex v) { return mesh.dimension(v) < 3; })) return false;
  const auto p = mesh.points(t);
  const Sphere sphere = circumsphere(p[0], p[1], p[2], p[3]);
  const double shortest = large_sphere * shortest_edge(p), mean = mean_edge(p);
  _center = sphere.center;
  _squared_radius = sphere.squared_radius;
  _least_edge = least_edge * mean;
  const auto within = [&](double low, double high) {
    return sphere.squared_radius > low * low && sphere.squared_radius < high * high;
  };
  return within(std::max(shortest, _least_edge), largest_sphere * mean) && mesh.quality(t) > 0;
}

bool VoidFilling::collect_cavity(const TetMesh& mesh, LocalIndex t) {
  _cavity.clear();
  _walls.clear();
  _cavity.old_tets.assign(1, t);
  ++_now;
  _state[t].inside = _now;
  for (std::size_t i = 0; i < _cavity.old_tets.size(); ++i) {
    const LocalIndex current = _cavity.old_tets[i];
    for (int f = 0; f < 4; ++f) {
      const HalfFace other = mesh.mate(4 * current + f);
      const LocalIndex next = other < 0 ? -1 : other >> 2;
      if (next < 0 || _state[next].inside == _now || _state[next].outside == _now) continue;
      const auto p = mesh.points(next);
      const Sphere sphere = circumsphere(p[0], p[1], p[2], p[3]);
      if (dot(_center - sphere.center, _center - sphere.center) >= sphere.squared_radius) {
        _state[next].outside = _now;
        continue;
      }
      const Vec3 apex = p[other & 3];
      _state[next].inside = _now;
      // Within a sphere that is in vain, no smaller one will do better.
      _state[next].in_vain = sphere.squared_radius <= _squared_radius;
      if (_cavity.old_tets.size() == most_tets || distance(apex, _center) < _least_edge) return false;
      _cavity.old_tets.push_back(next);
    }
  }
  for (const LocalIndex tet : _cavity.old_tets) {
    for (int f = 0; f < 4; ++f) {
      const HalfFace other = mesh.mate(4 * tet + f);
      if (other >= 0 && _state[other >> 2].inside == _now) continue;
      const auto& face = mesh::tetrahedron_faces[f];
      const Corners& c = mesh.corners(tet);
      _walls.push_back({{c[face[0]], c[face[2]], c[face[1]]}});
    }
  }
  return true;
}

// All vertices of the cavity stay on its walls: none is lost.
bool VoidFilling::keeps_vertices(const TetMesh& mesh) {
  _inside.clear();
  for (const Wall& wall : _walls) _inside.insert(_inside.end(), wall.corners.begin(), wall.corners.end());
  std::sort(_inside.begin(), _inside.end());
  return std::all_of(_cavity.old_tets.begin(), _cavity.old_tets.end(), [&](LocalIndex t) {
    const Corners& c = mesh.corners(t);
    return std::all_of(c.begin(), c.end(),
                       [&](LocalIndex v) { return std::binary_search(_inside.begin(), _inside.end(), v); });
  });
}

bool VoidFilling::gains(const TetMesh& mesh) {
  double old_sum = 0, edges = 0;
  _cavity.before = std::numeric_limits<double>::max();
  const auto count = static_cast<double>(_cavity.old_tets.size());
  for (const LocalIndex t : _cavity.old_tets) {
    const auto p = mesh.points(t);
    old_sum += mesh::mean_ratio(p[0], p[1], p[2], p[3]);
    edges += mean_edge(p) / count;
    _cavity.before = std::min(_cavity.before, mesh.quality(t));
  }
  double new_sum = 0;
  for (const Wall& wall : _walls) {
    const Vec3 a = mesh.point(wall.corners[0]), b = mesh.point(wall.corners[1]),
               c = mesh.point(wall.corners[2]);
    if (distance(a, _center) < least_edge * edges) return false;
    if (mesh.measure()(a, b, c, _center) <= _cavity.before || !has_positive_volume(a, b, c, _center))
      return false;
    new_sum += mesh::mean_ratio(a, b, c, _center);
  }
  return new_sum / static_cast<double>(_walls.size()) > old_sum / count + least_gain;
}

std::int64_t VoidFilling::run(TetMesh& mesh) {
  std::int64_t inserted = 0;
  const LocalIndex last = mesh.slot_count();
  _state.assign(last, {});
  for (LocalIndex t = 0; t < last; ++t) {
    if (!mesh.is_alive(t) || _state[t].in_vain || !is_candidate(mesh, t) || !collect_cavity(mesh, t) ||
        !gains(mesh) || !keeps_vertices(mesh)) {
      continue;
    }
    const LocalIndex v = mesh.add_vertex(_center, mesh.corners(t)[0]);
    for (const Wall& wall : _walls)
      _cavity.new_tets.push_back({wall.corners[0], wall.corners[1], wall.corners[2], v});
    mesh.replace(_cavity, _placed);
    _state.resize(mesh.slot_count());
    for (const LocalIndex placed : _placed) _state[placed].in_vain = false;
    ++inserted;
  }
  return inserted;
}

}  // namespace aeroloom::improve
