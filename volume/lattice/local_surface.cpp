#include "volume/lattice/local_surface.hpp"

#include "geometry/predicates.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::volume {

using geometry::orient3d;
using geometry::Vec3;

LocalSurface::LocalSurface(std::span<const SurfaceTriangle> triangles) {
  std::vector<mesh::GlobalIndex> numbers;
  numbers.reserve(3 * triangles.size());
  for (const SurfaceTriangle& t : triangles)
    numbers.insert(numbers.end(), t.vertices.begin(), t.vertices.end());
  geometry::sort_unique(numbers);
  _points.resize(numbers.size());
  _first_around.assign(numbers.size() + 1, 0);
  for (const SurfaceTriangle& t : triangles) {
    auto& local = _triangles.emplace_back();
    for (int k = 0; k < 3; ++k) {
      local[k] = static_cast<mesh::LocalIndex>(
          std::lower_bound(numbers.begin(), numbers.end(), t.vertices[k]) - numbers.begin());
      _points[local[k]] = t.points[k];
      ++_first_around[local[k] + 1];
    }
    _inside.push_back(t.inside);
    _outside.push_back(t.outside);
  }
  std::partial_sum(_first_around.begin(), _first_around.end(), _first_around.begin());
  _around.resize(3 * _triangles.size());
  std::vector<std::int32_t> next(_first_around.begin(), _first_around.end() - 1);
  for (std::size_t t = 0; t < _triangles.size(); ++t) {
    for (const auto v : _triangles[t]) _around[next[v]++] = static_cast<std::int32_t>(t);
  }
  if (!_triangles.empty()) _distance.emplace(_points, _triangles);
}

int LocalSurface::side_of(Vec3 p, std::int32_t triangle) const {
  const auto& t = _triangles[triangle];
  return orient3d(_points[t[0]], _points[t[1]], _points[t[2]], p);
}

mesh::RegionId LocalSurface::region_of(const Sight& sight) const {
  return sight.side < 0 ? _inside[sight.triangle] : _outside[sight.triangle];
}

std::vector<std::int32_t> LocalSurface::around(std::int32_t triangle) const {
  std::vector<std::int32_t> result;
  for (const auto v : _triangles[triangle])
    result.insert(result.end(), _around.begin() + _first_around[v], _around.begin() + _first_around[v + 1]);
  geometry::sort_unique(result);
  return result;
}

std::optional<mesh::RegionId> LocalSurface::common_region(std::span<const std::int32_t> triangles) const {
  const mesh::RegionId region = _inside[triangles.front()];
  for (const std::int32_t t : triangles) {
    if (_inside[t] != region || _outside[t] != region) return std::nullopt;
  }
  return region;
}

std::optional<LocalSurface::Sight> LocalSurface::first_on_way(
    Vec3 p, Vec3 q, std::int32_t target, std::span<const std::int32_t> candidates) const {
  Sight first{target, side_of(p, target)};
  if (first.side == 0) return std::nullopt;
  double nearest = 1;
  for (const std::int32_t t : candidates) {
    if (t == target) continue;
    const Vec3 a = _points[_triangles[t][0]], b = _points[_triangles[t][1]], c = _points[_triangles[t][2]];
    const int side = orient3d(a, b, c, p);
    if (side == 0 || side != -orient3d(a, b, c, q)) continue;
    const int ab = orient3d(p, q, a, b), bc = orient3d(p, q, b, c), ca = orient3d(p, q, c, a);
    const int least = std::min({ab, bc, ca}), most = std::max({ab, bc, ca});
    if (least < 0 && most > 0) continue;               // beside the triangle
    if (least == 0 || most == 0) return std::nullopt;  // through an edge
    const double before = std::abs(volume6(a, b, c, p)), after = std::abs(volume6(a, b, c, q));
    const double place = before / (before + after);
    if (place < nearest) nearest = place, first = {t, side};
  }
  return first;
}

std::optional<mesh::RegionId> LocalSurface::region_towards(Vec3 p, Vec3 q, std::int32_t triangle) const {
  geometry::Box way;
  way.add(p);
  way.add(q);
  std::vector<std::int32_t> candidates;
  _distance->for_each_in(
      way, [&](const BoundaryDistance::Measured& near) { candidates.push_back(near.triangle); });
  const auto sight = first_on_way(p, q, triangle, candidates);
  return sight ? std::optional(region_of(*sight)) : std::nullopt;
}

std::optional<mesh::RegionId> LocalSurface::region_at(Vec3 p,
                                                      const BoundaryDistance::Nearest& nearest) const {
  if (nearest.in_face) {
    const int side = side_of(p, nearest.triangle);
    if (side != 0) return region_of({nearest.triangle, side});
  }
  const std::vector<std::int32_t> candidates = around(nearest.triangle);
  if (const auto region = common_region(candidates)) return region;
  std::vector<std::int32_t> targets{nearest.triangle};
  constexpr double rounding = 1e-9;  // of distances to triangles that share the foot
  const double slack = nearest.distance * (1 + rounding);
  for (const std::int32_t t : candidates) {
    if (t != nearest.triangle && _distance->distance_to(p, t) <= slack) targets.push_back(t);
  }
  // The line to a point on an edge or vertex may run along the surface. A point a little inside the triangle
  // has a clear side; the nearer it is to the edge, the fewer triangles are in between. Chosen, not measured.
  for (const double inward : {1e-3, 4e-3, 1.6e-2, 6.4e-2}) {
    for (const std::int32_t target : targets) {
      const auto& v = _triangles[target];
      const Vec3 center = (1.0 / 3.0) * (_points[v[0]] + _points[v[1]] + _points[v[2]]);
      const Vec3 foot = _distance->foot_point(p, target);
      if (const auto sight = first_on_way(p, foot + inward * (center - foot), target, candidates))
        return region_of(*sight);
    }
  }
  return std::nullopt;
}

}  // namespace aeroloom::volume
