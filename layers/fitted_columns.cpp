#include "layers/fitted_columns.hpp"

#include "layers/gaps.hpp"
#include "layers/good_columns.hpp"
#include "layers/layer_validity.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
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

FittedColumns limit_columns(const LayerInput& in, Fans fans) {
  Directions directions = find_directions(in.wall, in.stars, fans);
  ColumnLimits limits(in.wall, in.wanted, in.edges, in.stars, directions);
  std::vector<std::int32_t> counts(in.wall.points.size(), most_layers);
  for (std::size_t v = 0; v < counts.size(); ++v) {
    if (fans.is_end[v] != 0) counts[v] = 0;
  }
  limits.limit_counts(std::move(counts), LayerLimit::no_direction);
  limits.converge();
  limit_by_gaps(in.wall, fans, directions, limits);
  limits.converge();
  const int rounds = shrink_to_good(in.wall, fans, directions, limits);
  return {std::move(fans), std::move(directions), std::move(limits), rounds};
}

/// Notes the heights of fans that are much lower than those their sectors were counted for. Returns whether
/// there are any on any rank. Collective.
bool find_low_fans(const LayerInput& in, const FittedColumns& columns, std::vector<double>& reached) {
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

/// Those of all fans. Collective.
double fan_columns(const LayerInput& in, const Fans& fans) {
  std::int64_t columns = 0;
  for (std::int32_t v = 0; v < in.wall.vertex_count(); ++v)
    columns += fans.count_at(v) > 1 && in.wall.owned[v] != 0 ? fans.count_at(v) : 0;
  return static_cast<double>(in.wall.mesh.communicator.sum(columns));
}

/// Whether most fans have no layers: in a duct that is narrow all over they would only make the front finer.
/// Collective.
bool has_empty_fans(const LayerInput& in, const FittedColumns& columns) {
  std::int64_t fans = 0, empty = 0;
  for (std::int32_t v = 0; v < in.wall.vertex_count(); ++v) {
    if (columns.fans.count_at(v) == 1 || in.wall.owned[v] == 0) continue;
    ++fans;
    empty += columns.limits.count(v) == 0 ? 1 : 0;
  }
  const parallel::Communicator& ranks = in.wall.mesh.communicator;
  return 2 * ranks.sum(empty) > ranks.sum(fans);
}

/// How often numbers of sectors are to be halved so that first layers are valid.
class SectorHalving {
public:
  explicit SectorHalving(const LayerInput& in)
      : _in(in), _halvings(in.wall.points.size(), 0), _hopeless(in.wall.points.size(), 0) {}

  /// Fans with a valid first layer, where there are any, and with as many sectors as the needs ask for on
  /// other ridges.
  Fans find(const std::vector<double>& reached) {
    constexpr int most_halvings = 3, most_starts = 2;  // the second leaves out what no number mends
    for (int start = 1;; ++start) {
      std::fill(_halvings.begin(), _halvings.end(), 0);
      for (int halving = 0;; ++halving) {
        Fans fans = find_fans(_in.wall, _in.stars, {_in.wanted, _in.edges, reached, _halvings});
        const std::vector<std::int32_t> bad = find_bad(fans);
        const bool is_good = _in.wall.mesh.communicator.sum(std::count(bad.begin(), bad.end(), 1)) == 0;
        if (is_good || (halving == most_halvings && start == most_starts)) return fans;
        std::vector<std::int32_t>& noted = halving == most_halvings ? _hopeless : _halvings;
        for (std::size_t v = 0; v < bad.size(); ++v) noted[v] += bad[v];
        if (halving == most_halvings) break;
      }
    }
  }

private:
  /// By vertex: 1 at both ends of a sector whose first layer is bad. Collective.
  std::vector<std::int32_t> find_bad(const Fans& fans) const {
    std::vector<std::int32_t> bad(_in.wall.points.size(), 0);
    for (const FanFace& face : fans.faces) {
      if (!face.is_sector()) continue;
      const std::array<std::int32_t, 2> ends{fans.vertex_of(face.columns[0]),
                                             fans.vertex_of(face.columns[2])};
      FanColumns first{{true, {1, 1}}, {}};
      for (int i = 0; i < 4; ++i) {
        const std::int32_t v = ends[i / 2];
        first.columns[i] = {_in.wall.points[v], fans.directions[face.columns[i]], {_in.wanted[v].first}, 1};
      }
      if (has_good_first_layer(first)) continue;
      for (const std::int32_t v : ends) bad[v] = 1 - _hopeless[v];
    }
    _in.wall.combine(bad, [](std::int32_t a, std::int32_t b) { return std::max(a, b); });
    return bad;
  }

  const LayerInput& _in;
  std::vector<std::int32_t> _halvings, _hopeless;  // by vertex; hopeless: no number is good
};

}  // namespace

FittedColumns fit_columns(const LayerInput& in) {
  // Of the columns of fans; chosen. A second attempt costs as much as the first.
  constexpr double many_fewer = 0.9;
  if (!in.may_have_fans) return limit_columns(in, without_fans(in.wall));
  std::vector<double> reached(in.wall.points.size(), std::numeric_limits<double>::infinity());
  std::optional columns(limit_columns(in, SectorHalving(in).find(reached)));
  if (find_low_fans(in, *columns, reached)) {
    Fans fans = SectorHalving(in).find(reached);
    if (fan_columns(in, fans) < many_fewer * fan_columns(in, columns->fans))
      columns.emplace(limit_columns(in, std::move(fans)));
  }
  if (has_empty_fans(in, *columns)) columns.emplace(limit_columns(in, without_fans(in.wall)));
  return std::move(*columns);
}

}  // namespace aeroloom::layers
