#include "layers/good_columns.hpp"

#include "geometry/sort_unique.hpp"
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

/// The faces of fans at vertices, each once.
std::vector<std::int32_t> faces_at(const Fans& fans, const std::vector<std::int32_t>& vertices) {
  std::vector<std::int32_t> faces;
  for (const std::int32_t v : vertices) {
    const auto around = fans.faces_around(v);
    faces.insert(faces.end(), around.begin(), around.end());
  }
  geometry::sort_unique(faces);
  return faces;
}

/// What all columns are made from.
struct ColumnSource {
  const LocalWall& wall;
  const Fans& fans;
  const Directions& directions;
  const ColumnLimits& limits;

  CornerColumn at(std::int32_t v, std::int32_t column) const {
    return {wall.points[v],  directions.smoothed[column], limits.heights(v), limits.count(v),
            wall.ends.get(), directions.ends.at(v)};
  }
  TriangleColumns over(std::int32_t triangle) const {
    TriangleColumns columns;
    for (int i = 0; i < 3; ++i) columns[i] = at(wall.triangles[triangle][i], fans.columns[triangle][i]);
    return columns;
  }
  FanColumns over(const FanFace& face) const {
    const std::array<std::int32_t, 2> ends{fans.vertex_of(face.columns[0]), fans.vertex_of(face.columns[2])};
    FanColumns columns;
    columns.over = {face.is_sector(), {limits.count(ends[0]), limits.count(ends[1])}};
    for (int i = 0; i < (face.is_sector() ? 4 : 3); ++i)
      columns.columns[i] = at(ends[i / 2], face.columns[i]);
    return columns;
  }
};

}  // namespace

int shrink_to_good(const LocalWall& wall, const Fans& fans, const Directions& directions,
                   ColumnLimits& limits) {
  const ColumnSource source{wall, fans, directions, limits};
  std::vector<std::uint8_t> seen(wall.triangles.size(), 0);
  for (int rounds = 0;; ++rounds) {
    std::vector<double> totals(wall.points.size(), std::numeric_limits<double>::infinity());
    std::int64_t bad = 0;
    const auto bound = [&](std::int32_t v, double height) {
      if (limits.total(v) > height) totals[v] = std::min(totals[v], height);
    };
    const std::vector<std::int32_t> changed = limits.take_changed();
    for (const std::int32_t t : triangles_at(wall, changed, seen)) {
      const double height = fitting_height(source.over(t));
      if (height == std::numeric_limits<double>::infinity()) continue;
      ++bad;
      for (const std::int32_t v : wall.triangles[t]) bound(v, height);
    }
    for (const std::int32_t f : faces_at(fans, changed)) {
      const FanFace& face = fans.faces[f];
      const double height = fitting_height(source.over(face));
      if (height == std::numeric_limits<double>::infinity()) continue;
      ++bad;
      for (const int end : {0, 2}) bound(fans.vertex_of(face.columns[end]), height);
    }
    if (wall.mesh.communicator.sum(bad) == 0) return rounds;
    limits.limit_totals(std::move(totals), LayerLimit::validity);
    limits.converge();
  }
}

}  // namespace aeroloom::layers
