// The few triangles that are sharp in the end, most of them beside a long edge on the border: their vertices move
// where the smallest angle around them is largest (Freitag, Jones and Plassmann, An efficient parallel algorithm
// for mesh smoothing, 4th International Meshing Roundtable, 1995), with a search by pattern.
#include "surface/face_remesher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace aeroloom::surface {

using geometry::Vec3;

namespace {

constexpr double sharp_degrees = 26;
constexpr int rounds = 8;
constexpr int directions = 8;
/// Steps of the search, in lengths of the shortest edge around the vertex.
constexpr std::array<double, 4> steps{0.5, 0.25, 0.12, 0.05};

}  // namespace

double FaceRemesher::smallest_sine_around(std::int32_t vertex) {
  _links.gather_fan(vertex, _fan);
  double least = 1;
  for (const std::int32_t t : _fan) {
    const auto& v = _links.triangles[t].vertices;
    least = std::min(least, smallest_sine(v[0], v[1], v[2]));
  }
  return least;
}

bool FaceRemesher::widen_vertex(std::int32_t vertex) {
  if (!_links.gather_fan(vertex, _fan)) return false;
  double shortest = std::numeric_limits<double>::max();
  PatchShape before;
  for (const std::int32_t t : _fan) {
    before.add(shape(t));
    for (const std::int32_t v : _links.triangles[t].vertices) {
      if (v != vertex) shortest = std::min(shortest, distance(_mesh.points[v], _mesh.points[vertex]));
    }
  }
  bool moved = false;
  double best = smallest_sine_around(vertex);
  for (const double step : steps) {
    const Place start = place_of(vertex);
    const Vec3 normal = start.normal;
    const Vec3 away = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 first = normalized(cross(normal, away)), second = cross(normal, first);
    Place chosen = start;
    for (int i = 0; i < directions; ++i) {
      const double angle = 2 * std::numbers::pi * i / directions;
      const Vec3 direction = std::cos(angle) * first + std::sin(angle) * second;
      Place place;
      put(vertex, start);
      if (!project(start.point + step * shortest * direction, vertex, step * shortest, place)) continue;
      PatchShape after;
      for (const std::int32_t t : _fan) after.add(shape_with(t, vertex, place));
      if (!(after.facing >= std::min(before.facing, least_facing))) continue;
      put(vertex, place);
      const double sine = smallest_sine_around(vertex);
      if (sine > best * (1 + 1e-6)) best = sine, chosen = place, moved = true;
    }
    put(vertex, chosen);
  }
  return moved;
}

void FaceRemesher::widen_sharp_triangles() {
  const double limit = std::pow(std::sin(sharp_degrees * std::numbers::pi / 180), 2);
  for (int round = 0; round < rounds; ++round) {
    std::fill(_active.begin(), _active.end(), 0);
    bool changed = false;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(_links.triangles.size()); ++t) {
      if (!is_live(t)) continue;
      const std::array<std::int32_t, 3> corners{_links.triangles[t].vertices[0], _links.triangles[t].vertices[1],
                                                _links.triangles[t].vertices[2]};
      if (smallest_sine(corners[0], corners[1], corners[2]) >= limit) continue;
      for (const std::int32_t v : corners) {
        _active[v] = 1;
        if (!is_free(v) || !widen_vertex(v)) continue;
        changed = true;
        for (const std::int32_t s : _fan) {
          for (const std::int32_t w : _links.triangles[s].vertices) _active[w] = 1;
        }
      }
    }
    if (!changed) return;
    flip_edges();
  }
}

}  // namespace aeroloom::surface
