#include "layers/good_columns.hpp"

#include "layers/layer_validity.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace aeroloom::layers {
namespace {

/// The layered triangles around vertices, each once.
std::vector<std::int32_t> triangles_at(const LocalWall& wall, const std::vector<std::int32_t>& vertices,
                                       std::vector<std::uint8_t>& seen) {
  std::vector<std::int32_t> triangles;
  for (const std::int32_t v : vertices) {
    for (const std::int32_t t : wall.triangles_around(v)) {
      if (wall.roles[t] != WallRole::layered || seen[t] != 0) continue;
      seen[t] = 1;
      triangles.push_back(t);
    }
  }
  for (const std::int32_t t : triangles) seen[t] = 0;
  return triangles;
}

/// The columns of a triangle's corners.
TriangleColumns columns_over(const LocalWall& wall, const Directions& directions, const ColumnLimits& limits,
                             std::int32_t triangle) {
  TriangleColumns columns;
  for (int i = 0; i < 3; ++i) {
    const std::int32_t v = wall.triangles[triangle][i];
    columns[i] = {wall.points[v], directions.smoothed[v], limits.heights(v), limits.count(v)};
  }
  return columns;
}

}  // namespace

int shrink_to_good(const LocalWall& wall, const Directions& directions, ColumnLimits& limits) {
  std::vector<std::uint8_t> seen(wall.triangles.size(), 0);
  for (int rounds = 0;; ++rounds) {
    std::vector<double> totals(wall.points.size(), std::numeric_limits<double>::infinity());
    std::int64_t bad = 0;
    for (const std::int32_t t : triangles_at(wall, limits.take_changed(), seen)) {
      const TriangleColumns columns = columns_over(wall, directions, limits, t);
      const double height = fitting_height(columns);
      if (height == std::numeric_limits<double>::infinity()) continue;
      ++bad;
      for (int i = 0; i < 3; ++i) {
        double& total = totals[wall.triangles[t][i]];
        if (columns[i].heights.total(columns[i].count) > height) total = std::min(total, height);
      }
    }
    if (wall.mesh.communicator.sum(bad) == 0) return rounds;
    limits.limit_totals(std::move(totals), LayerLimit::validity);
    limits.converge();
  }
}

}  // namespace aeroloom::layers
