// The few triangles that are sharp in the end, most of them beside a long edge on the border: their vertices
// move where the smallest angle around them gets largest (Freitag, Jones and Plassmann, An efficient parallel
// algorithm for mesh smoothing, 4th International Meshing Roundtable, 1995), with a search by pattern.
#include "surface/remesh/face_remesher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace aeroloom::surface {

using geometry::Vec3;

namespace {

// Squared sines of angles. Triangles below the first are worked on, a little less than the 28 degrees that
// improvement aims at in the volume; no other may fall below the second for them. Chosen, not measured.
const double sharp_sine = std::pow(std::sin(26 * std::numbers::pi / 180), 2);
const double guarded_sine = std::pow(std::sin(18 * std::numbers::pi / 180), 2);
constexpr int rounds = 6, directions = 8;  // chosen, not measured
/// Gains of a squared sine, relative, that are more than rounding.
constexpr double real_gain = 1 + 1e-6;
/// The x axis is no axis to turn about where the normal is nearer to it than by this cosine; the y axis then
/// is.
constexpr double near_axis = 0.6;
/// Steps of the search, in lengths of the shortest edge around the vertex.
constexpr std::array<double, 4> steps{0.5, 0.25, 0.12, 0.05};

}  // namespace

/// The smallest angle around the vertex as it is now, if no triangle of the fan has got sharp, or sharper,
/// for it; `before` has their angles. Angles are squared sines.
std::optional<double> FaceRemesher::judge_fan(const std::vector<double>& before) const {
  double least = 1;
  for (std::size_t i = 0; i < _fan.size(); ++i) {
    const auto& v = _links.triangles[_fan[i]].vertices;
    const double sine = smallest_sine(v[0], v[1], v[2]);
    if (sine < std::min(before[i], guarded_sine)) return std::nullopt;
    least = std::min(least, sine);
  }
  return least;
}

bool FaceRemesher::widen_vertex(std::int32_t vertex) {
  if (!_links.gather_fan(vertex, _fan)) return false;
  double shortest = std::numeric_limits<double>::max(), best = 1;
  TriangleShapes before;
  std::vector<double>& sines = _fan_sines;
  sines.clear();
  for (const std::int32_t t : _fan) {
    before.add(shape(t));
    const auto& v = _links.triangles[t].vertices;
    sines.push_back(smallest_sine(v[0], v[1], v[2]));
    best = std::min(best, sines.back());
    for (const std::int32_t w : v) {
      if (w != vertex) shortest = std::min(shortest, distance(_mesh.points[w], _mesh.points[vertex]));
    }
  }
  bool moved = false;
  for (const double step : steps) {
    const VertexPlace start = place_of(vertex);
    const Vec3 away = std::abs(start.normal.x) < near_axis ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 first = normalized(cross(start.normal, away)), second = cross(start.normal, first);
    VertexPlace chosen = start;
    for (int i = 0; i < directions; ++i) {
      const double angle = 2 * std::numbers::pi * i / directions;
      const Vec3 direction = std::cos(angle) * first + std::sin(angle) * second;
      VertexPlace place;
      put(vertex, start);
      if (!project(start.point + step * shortest * direction, vertex, step * shortest, place)) continue;
      TriangleShapes after;
      for (const std::int32_t t : _fan) after.add(shape_with(t, vertex, place));
      if (after.facing < std::min(before.facing, least_facing)) continue;
      put(vertex, place);
      const auto sine = judge_fan(sines);
      if (sine && *sine > best * real_gain) best = *sine, chosen = place, moved = true;
    }
    put(vertex, chosen);
  }
  return moved;
}

void FaceRemesher::widen_sharp_triangles() {
  std::fill(_active.begin(), _active.end(), 1);
  for (int round = 0; round < rounds; ++round) {
    std::fill(_next.begin(), _next.end(), 0);
    bool changed = false;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(_links.triangles.size()); ++t) {
      if (!is_live(t)) continue;
      const std::array<std::int32_t, 3> corners = _links.triangles[t].vertices;
      if (smallest_sine(corners[0], corners[1], corners[2]) >= sharp_sine) continue;
      for (const std::int32_t v : corners) {
        if (!_active[v] || !is_free(v) || !widen_vertex(v)) continue;
        changed = true;
        note_fan();
      }
    }
    if (!changed) return;
    end_sweep();
    flip_edges();
  }
}

}  // namespace aeroloom::surface
