#include "layers/directions.hpp"

#include "layers/cone.hpp"
#include "layers/end_planes.hpp"

#include <algorithm>
#include <functional>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

/// The scaled Jacobian of flat prisms at an equilateral triangle is the visibility, and columns may rise
/// until half of it is left: 0.01. Closed trailing edges of 2.3 degrees have it.
constexpr double least_visibility = 0.02;
/// Smoothing leaves at least so much of the visibility of the most normal direction: 26 degrees on a flat
/// wall. Chosen, not measured.
constexpr double kept_visibility = 0.9;
/// Smoothing reaches about as many edges from a ridge as columns are high. Chosen, not measured.
constexpr int smoothing_sweeps = 8;

/// Moves a direction towards the mean of its neighbours, as far as the visibility allows of the steps tried.
/// The result lies in the planes of the vertex.
Vec3 move_towards(Vec3 mean, Vec3 present, double least, const VertexStars& stars, std::int32_t v) {
  for (const double step : {0.5, 0.25, 0.125}) {
    const Vec3 moved = normalized(along_planes((1 - step) * present + step * mean, stars.planes_at(v)));
    if (visibility_of(moved, stars.normals_at(v)) >= least) return moved;
  }
  return present;
}

}  // namespace

Directions find_directions(const LocalWall& wall, const VertexStars& stars, const Fans& fans) {
  const std::int32_t count = wall.vertex_count();
  Directions directions;
  directions.most_normal = fans.directions;
  directions.visibility = fans.visibility;
  directions.ends = stars.ends;
  const auto is_single = [&](std::int32_t v) { return fans.count_at(v) == 1; };
  for (std::int32_t v = 0; v < count; ++v) {
    if (stars.kinds[v] != StarKind::plain || !is_single(v)) continue;
    const Vec3 axis = normalized(along_planes(smallest_cone(stars.normals_at(v)).axis, stars.planes_at(v)));
    const double visibility = visibility_of(axis, stars.normals_at(v));
    if (!(visibility >= least_visibility)) continue;
    directions.most_normal[fans.first[v]] = axis;
    directions.visibility[v] = visibility;
  }
  directions.smoothed = directions.most_normal;
  std::vector<Vec3> sums(count);
  for (int sweep = 0; sweep < smoothing_sweeps; ++sweep) {
    for (std::int32_t v = 0; v < count; ++v) {
      sums[v] = {};
      for (const std::int32_t t : wall.triangles_around(v)) {
        if (wall.roles[t] != WallRole::layered) continue;
        for (int i = 0; i < 3; ++i) {
          if (wall.triangles[t][i] != v) sums[v] += directions.smoothed[fans.columns[t][i]];
        }
      }
    }
    wall.combine(sums, std::plus<>());
    for (std::int32_t v = 0; v < count; ++v) {
      if (directions.visibility[v] == 0 || !is_single(v)) continue;
      const double least = std::max(least_visibility, kept_visibility * directions.visibility[v]);
      Vec3& direction = directions.smoothed[fans.first[v]];
      direction = move_towards(normalized(sums[v]), direction, least, stars, v);
    }
  }
  directions.slants.assign(count, 1);
  for (std::int32_t v = 0; v < count; ++v) {
    if (directions.visibility[v] == 0) continue;
    if (!is_single(v)) {
      directions.slants[v] = fans.leans[v];
      continue;
    }
    const Vec3 direction = directions.smoothed[fans.first[v]];
    double largest = -1;
    for (const Vec3 normal : stars.normals_at(v)) largest = std::max(largest, dot(direction, normal));
    directions.visibility[v] = visibility_of(direction, stars.normals_at(v));
    directions.slants[v] = 0.5 * (directions.visibility[v] + largest);
  }
  return directions;
}

}  // namespace aeroloom::layers
