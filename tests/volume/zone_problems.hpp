/// Problems of zones made of surfaces and random points, for tests of what fills them.
#pragma once

#include "tests/meshes/surfaces.hpp"
#include "volume/filling/owned_cells.hpp"
#include "volume/lattice/boundary_distance.hpp"

#include <algorithm>
#include <random>

namespace aeroloom::volume {

using geometry::Vec3;
using mesh::LocalIndex;
using mesh::no_region;
using mesh::RegionId;

inline std::vector<double> flat(const std::vector<Vec3>& points) {
  std::vector<double> coordinates;
  for (const Vec3& p : points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
  return coordinates;
}

template <std::size_t n>
std::array<LocalIndex, n> sorted(std::array<LocalIndex, n> indices) {
  std::sort(indices.begin(), indices.end());
  return indices;
}

inline double volume_of(const LocalCell& c, const std::vector<Vec3>& points) {
  return volume6(points[c[0]], points[c[1]], points[c[2]], points[c[3]]) / 6;
}

/// A problem of all points of a surface and `inner` random ones off it; `region_of` tells theirs.
template <class RegionOf>
ZoneProblem make_problem(const surfaces::Surface& surface, int inner, double clearance,
                         const RegionOf& region_of) {
  ZoneProblem problem;
  problem.points = surface.points;
  problem.triangles = surface.triangles;
  for (const std::int32_t f : surface.face) {
    problem.inside.push_back(surface.sides[f].front);
    problem.outside.push_back(surface.sides[f].back);
  }
  geometry::Box box;
  for (const Vec3& p : surface.points) box.add(p);
  const BoundaryDistance distance(surface.points, surface.triangles);
  std::mt19937_64 random(17);
  const auto between = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  while (static_cast<int>(problem.regions.size()) < inner) {
    const Vec3 p{between(box.low.x, box.high.x), between(box.low.y, box.high.y),
                 between(box.low.z, box.high.z)};
    const RegionId region = region_of(p);
    if (region == no_region || distance.nearest(p).distance < clearance) continue;
    problem.points.push_back(p);
    problem.regions.push_back(region);
  }
  problem.owners.assign(problem.points.size(), Owner::mine);
  return problem;
}

inline ZoneProblem cube_problem() {
  return make_problem(surfaces::cube({0, 0, 0}, 1, 6), 400, 0.1, [](Vec3) { return 0; });
}

/// As the zone of number `zone` sees it, vertices divided by `zone_of(place)`.
template <class ZoneOf>
ZoneProblem seen_from(ZoneProblem problem, int zone, const ZoneOf& zone_of) {
  for (std::size_t v = 0; v < problem.points.size(); ++v) {
    const int z = zone_of(problem.points[v]);
    problem.owners[v] = z == zone ? Owner::mine : z < zone ? Owner::lower : Owner::higher;
  }
  return problem;
}

}  // namespace aeroloom::volume
