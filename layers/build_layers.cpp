#include "layers/directions.hpp"
#include "layers/gaps.hpp"
#include "layers/good_columns.hpp"
#include "layers/layer_cap.hpp"
#include "layers/layer_report.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"

#include <cstdint>
#include <limits>
#include <utility>

namespace aeroloom::layers {
namespace {

/// The smallest gap that does not limit a column.
double ample_gap_of(const ColumnLimits& limits, std::int32_t v) {
  return ample_gap(limits.total(v), limits.mean_edge(v));
}

/// The balls that measure the gaps of columns. Only the lowest piece with a vertex needs one.
std::vector<TouchingBall> balls_on(const LocalWall& wall, const Directions& directions,
                                   const ColumnLimits& limits) {
  std::vector<TouchingBall> balls(wall.points.size());
  for (std::int32_t v = 0; v < wall.vertex_count(); ++v) {
    if (limits.count(v) == 0 || wall.owned[v] == 0) continue;
    balls[v] = {wall.points[v], directions.most_normal[v], ample_gap_of(limits, v)};
  }
  return balls;
}

/// Limits totals to the room in the gaps.
void limit_by_gaps(const LocalWall& wall, const Directions& directions, ColumnLimits& limits) {
  std::vector<double> gaps = find_gaps(wall, balls_on(wall, directions, limits));
  wall.spread(gaps);
  std::vector<double> totals(gaps.size(), std::numeric_limits<double>::infinity());
  for (std::int32_t v = 0; v < wall.vertex_count(); ++v) {
    if (limits.count(v) == 0 || gaps[v] >= ample_gap_of(limits, v)) continue;
    totals[v] = room_in_gap(gaps[v], limits.mean_edge(v), directions.visibility[v]);
  }
  limits.limit_totals(std::move(totals), LayerLimit::gap);
}

}  // namespace

Layers build_layers(const mesh::NumberedMesh& wall, const LayerOptions& options,
                    const PlaneRemesher& remesh_planes) {
  const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::task);
  parallel::add_pieces(static_cast<std::int64_t>(wall.pieces.size()));
  const LocalWall walls(wall, options);
  const VertexStars stars = gather_stars(walls);
  const Directions directions = find_directions(walls, stars);
  ColumnLimits limits(walls, options, stars, directions);
  limits.converge();
  limit_by_gaps(walls, directions, limits);
  limits.converge();
  Layers layers;
  layers.report.validity_rounds = shrink_to_good(walls, directions, limits);
  layers.cap = CapClearing(walls, directions, remesh_planes).run(limits, layers.report);
  layers.columns = make_columns(walls, directions, limits);
  layers.report.patches = report_patches(walls, directions, limits, options);
  return layers;
}

}  // namespace aeroloom::layers
