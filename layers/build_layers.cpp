#include "layers/directions.hpp"
#include "layers/gaps.hpp"
#include "layers/good_columns.hpp"
#include "layers/layer_cap.hpp"
#include "layers/layer_report.hpp"
#include "layers/opened_wall.hpp"
#include "layers/ridge_paths.hpp"
#include "layers/sectors.hpp"
#include "layers/side_layers.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace aeroloom::layers {
namespace {

/// The smallest gap that does not limit a column.
double ample_gap_of(const ColumnLimits& limits, std::int32_t v) {
  return ample_gap(limits.total(v), limits.mean_edge(v));
}

/// The balls that measure the gaps of columns. Only the lowest piece with a vertex needs them.
std::vector<TouchingBall> balls_on(const LocalWall& wall, const Fans& fans, const Directions& directions,
                                   const ColumnLimits& limits) {
  std::vector<TouchingBall> balls(fans.column_count());
  for (std::int32_t v = 0; v < wall.vertex_count(); ++v) {
    if (limits.count(v) == 0 || wall.owned[v] == 0) continue;
    for (std::int32_t c = fans.first[v]; c < fans.first[v + 1]; ++c)
      balls[c] = {wall.points[v], directions.most_normal[c], ample_gap_of(limits, v)};
  }
  return balls;
}

/// Limits totals to the room in the gaps.
void limit_by_gaps(const LocalWall& wall, const Fans& fans, const Directions& directions,
                   ColumnLimits& limits) {
  const std::vector<double> of_columns = find_gaps(wall, balls_on(wall, fans, directions, limits));
  std::vector<double> gaps(wall.points.size());
  for (std::int32_t v = 0; v < wall.vertex_count(); ++v)
    gaps[v] = *std::min_element(of_columns.begin() + fans.first[v], of_columns.begin() + fans.first[v + 1]);
  wall.spread(gaps);
  std::vector<double> totals(gaps.size(), std::numeric_limits<double>::infinity());
  for (std::int32_t v = 0; v < wall.vertex_count(); ++v) {
    if (limits.count(v) == 0 || gaps[v] >= ample_gap_of(limits, v)) continue;
    totals[v] = room_in_gap(gaps[v], limits.mean_edge(v), directions.visibility[v]);
  }
  limits.limit_totals(std::move(totals), LayerLimit::gap);
}

/// Columns as limits leave them.
struct LimitedColumns {
  Fans fans;
  Directions directions;
  ColumnLimits limits;
  int rounds = 0;  ///< until all cells were good
};

/// What columns follow from.
struct LayerInput {
  const LocalWall& wall;
  const VertexStars& stars;
  const std::vector<VertexLayers>& wanted;
  const std::vector<double>& edges;
  LayerElements elements;
};

LimitedColumns limit_columns(const LayerInput& in, Fans fans) {
  Directions directions = find_directions(in.wall, in.stars, fans);
  ColumnLimits limits(in.wall, in.wanted, in.edges, in.stars, directions);
  limits.converge();
  limit_by_gaps(in.wall, fans, directions, limits);
  limits.converge();
  const int rounds = shrink_to_good(in.wall, fans, directions, limits);
  return {std::move(fans), std::move(directions), std::move(limits), rounds};
}

/// Notes the heights of fans that are much lower than those their sectors were counted for. Returns whether
/// there are any on any rank. Collective.
bool find_low_fans(const LayerInput& in, const LimitedColumns& columns, std::vector<double>& reached) {
  constexpr double low = 0.6;  // chosen, not measured
  std::int64_t found = 0;
  for (std::int32_t v = 0; v < in.wall.vertex_count(); ++v) {
    if (columns.fans.count_at(v) == 1) continue;
    const double height = columns.limits.total(v);
    if (height >= low * std::min(reached[v], wanted_height(in.wanted[v], in.edges[v]))) continue;
    reached[v] = height;
    ++found;
  }
  return in.wall.mesh.communicator.sum(found) > 0;
}

/// By vertex: 1 where a path or the free rim of a baffle is, or at a neighbour. Collective.
std::vector<std::int32_t> find_excused(const LayerInput& in) {
  const auto is_excused = [](const Ridge::Edge& edge) { return edge.is_rim || edge.is_path; };
  std::vector<std::int32_t> excused(in.wall.points.size(), 0);
  for (std::int32_t v = 0; v < in.wall.vertex_count(); ++v) {
    const Ridge* ridge = in.stars.ridge_at(v);
    if (ridge == nullptr || std::none_of(ridge->edges.begin(), ridge->edges.end(), is_excused)) continue;
    excused[v] = 1;
    in.wall.for_each_neighbour(v, [&](std::int32_t other) { excused[other] = 1; });
  }
  in.wall.combine(excused, [](std::int32_t a, std::int32_t b) { return std::max(a, b); });
  return excused;
}

/// Whether a ridge has a fan without layers, which is an end on a wall. Paths and the free rims of baffles
/// may, unless most of all fans are so: in a narrow duct they would only make the front finer. Collective.
bool has_empty_fans(const LayerInput& in, const LimitedColumns& columns) {
  const std::vector<std::int32_t> excused = find_excused(in);
  std::int64_t fans = 0, empty = 0, not_excused = 0;
  for (std::int32_t v = 0; v < in.wall.vertex_count(); ++v) {
    if (columns.fans.count_at(v) == 1 || in.wall.owned[v] == 0) continue;
    ++fans;
    if (columns.limits.count(v) > 0) continue;
    ++empty;
    not_excused += excused[v] == 0 ? 1 : 0;
  }
  const parallel::Communicator& ranks = in.wall.mesh.communicator;
  return 2 * ranks.sum(empty) > ranks.sum(fans) || ranks.sum(not_excused) > 0;
}

/// Columns with fans whose sectors fit the heights that are reached, or without any fan where one would have
/// no layers.
LimitedColumns fit_columns(const LayerInput& in) {
  constexpr int most_attempts = 4;
  if (in.elements == LayerElements::tets) return limit_columns(in, without_fans(in.wall));
  std::vector<double> reached(in.wall.points.size(), std::numeric_limits<double>::infinity());
  for (int attempt = 1;; ++attempt) {
    LimitedColumns columns = limit_columns(in, find_fans(in.wall, in.stars, in.wanted, in.edges, reached));
    if (has_empty_fans(in, columns)) return limit_columns(in, without_fans(in.wall));
    if (attempt == most_attempts || !find_low_fans(in, columns, reached)) return columns;
  }
}

/// Of a wall without inner faces, or of an opened one.
Layers build_on(const mesh::NumberedMesh& wall, const LayerOptions& options, const OpenedWall* opened,
                const PlaneRemesher& remesh_planes) {
  const LocalWall walls(wall, options);
  VertexStars stars = gather_stars(walls);
  if (const PathEdges paths = find_ridge_paths(walls, stars); !paths.empty())
    stars = gather_stars(walls, paths);
  const std::vector<VertexLayers> wanted = gather_wanted_layers(walls, options);
  const std::vector<double> edges = smooth_mean_edges(walls, wanted);
  LimitedColumns found = fit_columns({walls, stars, wanted, edges, options.elements});
  const Fans& fans = found.fans;
  const Directions& directions = found.directions;
  ColumnLimits& limits = found.limits;
  Layers layers;
  layers.report.validity_rounds = found.rounds;
  layers.cap = CapClearing(walls, fans, directions, {remesh_planes, opened}).run(limits, layers.report);
  layers.columns = make_columns(walls, fans, directions, limits);
  layers.report.patches = report_patches(walls, fans, directions, limits, options);
  return layers;
}

}  // namespace

Layers build_layers(const mesh::NumberedMesh& wall, const LayerOptions& options,
                    const PlaneRemesher& remesh_planes) {
  const parallel::ScopedCpu cpu(parallel::ScopedCpu::As::task);
  parallel::add_pieces(static_cast<std::int64_t>(wall.pieces.size()));
  if (!has_inner_layers(wall, options)) return build_on(wall, options, nullptr, remesh_planes);
  const auto opened = std::make_shared<const OpenedWall>(open_inner_faces(wall));
  Layers layers = build_on(opened->mesh, options_of_sides(*opened, options), opened.get(), remesh_planes);
  layers.report.patches = join_sides(*opened, layers.report.patches);
  layers.opened = opened;
  return layers;
}

}  // namespace aeroloom::layers
