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

/// Gaps at vertices. They are measured again only where the number of columns has changed or wider ones are
/// sought.
class MeasuredGaps {
public:
  explicit MeasuredGaps(const LocalWall& wall) : _wall(wall), _known(wall.points.size()) {}

  /// By vertex. Collective.
  std::vector<double> measure(const Fans& fans, const Directions& directions, const ColumnLimits& limits) {
    const std::vector<double> of_columns = find_gaps(_wall, unknown_balls(fans, directions, limits));
    std::vector<double> gaps(_wall.points.size());
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
      if (_known[v].is_new)
        _known[v].gap =
            *std::min_element(of_columns.begin() + fans.first[v], of_columns.begin() + fans.first[v + 1]);
      _known[v].is_new = false;
      gaps[v] = _known[v].gap;
    }
    _wall.spread(gaps);
    return gaps;
  }

private:
  struct Known {
    double gap = 0, sought = 0;
    std::int32_t columns = 0;
    bool is_new = false;
  };

  /// Only the lowest piece with a vertex needs them.
  std::vector<TouchingBall> unknown_balls(const Fans& fans, const Directions& directions,
                                          const ColumnLimits& limits) {
    std::vector<TouchingBall> balls(fans.column_count());
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
      if (limits.count(v) == 0 || _wall.owned[v] == 0) continue;
      const double sought = ample_gap_of(limits, v);
      if (_known[v].columns == fans.count_at(v) && sought <= _known[v].sought) continue;
      _known[v] = {0, sought, fans.count_at(v), true};
      for (std::int32_t c = fans.first[v]; c < fans.first[v + 1]; ++c)
        balls[c] = {_wall.points[v], directions.most_normal[c], sought};
    }
    return balls;
  }

  const LocalWall& _wall;
  std::vector<Known> _known;
};

/// Limits totals to the room in the gaps.
void limit_by_gaps(const std::vector<double>& gaps, const Directions& directions, ColumnLimits& limits) {
  std::vector<double> totals(gaps.size(), std::numeric_limits<double>::infinity());
  for (std::int32_t v = 0; v < static_cast<std::int32_t>(gaps.size()); ++v) {
    if (limits.count(v) == 0 || gaps[v] >= ample_gap_of(limits, v)) continue;
    totals[v] = room_in_gap(gaps[v], limits.mean_edge(v), directions.visibility[v]);
  }
  limits.limit_totals(std::move(totals), LayerLimit::gap);
}

/// What is known of columns that were built before.
struct KnownColumns {
  MeasuredGaps gaps;
  JudgedColumns judged;
};

FittedColumns limit_columns(const LayerInput& in, KnownColumns& known, Fans fans,
                            std::vector<Bend> bends = {}) {
  Directions directions = find_directions(in.wall, in.stars, fans);
  directions.bends = std::move(bends);
  ColumnLimits limits(in.wall, in.wanted, in.fitted, in.stars, directions);
  std::vector<std::int32_t> counts(in.wall.points.size(), most_layers);
  for (std::size_t v = 0; v < counts.size(); ++v) {
    if (fans.is_end[v] != 0) counts[v] = 0;
  }
  limits.limit_counts(std::move(counts), LayerLimit::no_direction);
  limits.converge();
  limit_by_gaps(known.gaps.measure(fans, directions, limits), directions, limits);
  limits.converge();
  const bool is_judged_again = in.may_have_fans && directions.bends.empty();
  const int rounds =
      shrink_to_good(in.wall, fans, directions, limits, is_judged_again ? &known.judged : nullptr);
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
    if (height >= low * std::min(reached[v], wanted_height(in.wanted[v], in.fitted[v]))) continue;
    reached[v] = height;
    ++found;
  }
  return in.wall.mesh.communicator.sum(found) > 0;
}

/// Whether a fan has at most three quarters of the sectors it had, on any rank. Collective.
bool have_fewer(const LayerInput& in, const Fans& before, const Fans& now) {
  std::int64_t fewer = 0;
  for (std::int32_t v = 0; v < in.wall.vertex_count(); ++v) {
    const std::int32_t sectors = before.count_at(v) - 1;
    if (sectors > 0 && 4 * (now.count_at(v) - 1) <= 3 * sectors) ++fewer;
  }
  return in.wall.mesh.communicator.sum(fewer) > 0;
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
      : _in(in),
        _ridges(list_ridge_edges(in.wall, in.stars, in.edges)),
        _halvings(3 * in.wall.triangles.size(), 0) {}

  /// Fans with a valid first layer, and with as many sectors as the needs ask for on other ridges. Where no
  /// number mends it there are none.
  Fans find(std::vector<double> reached) {
    constexpr int most_halvings = 3;
    for (;;) {
      std::fill(_halvings.begin(), _halvings.end(), 0);
      for (int halving = 0;; ++halving) {
        Fans fans =
            find_fans(_in.wall, _in.stars, {_in.wanted, _in.fitted, _ridges, _in.edges, reached, _halvings});
        const std::vector<std::int32_t> bad = find_bad(fans);
        if (_in.wall.mesh.communicator.sum(std::count(bad.begin(), bad.end(), 1)) == 0) return fans;
        if (halving == most_halvings) {
          leave_out(bad, reached);
          break;
        }
        for (std::size_t e = 0; e < bad.size(); ++e) _halvings[e] += bad[e];
      }
    }
  }

private:
  /// By edge of a triangle, as FanNeeds::halvings: 1 where the first layer over a sector is bad.
  std::vector<std::int32_t> find_bad(const Fans& fans) const {
    std::vector<std::int32_t> bad(_halvings.size(), 0);
    for (const FanFace& face : fans.faces) {
      if (!face.is_sector()) continue;
      const std::array<std::int32_t, 2> ends{fans.vertex_of(face.columns[0]),
                                             fans.vertex_of(face.columns[2])};
      if (fans.is_end[ends[0]] + fans.is_end[ends[1]] > 0) continue;
      FanColumns first{{true, {1, 1}}, {}};
      for (int i = 0; i < 4; ++i) {
        const std::int32_t v = ends[i / 2];
        first.columns[i] = {_in.wall.points[v], fans.directions[face.columns[i]], {_in.wanted[v].first}, 1};
      }
      if (has_good_first_layer(first)) continue;
      bad[3 * static_cast<std::size_t>(face.triangle) + _in.wall.corner_of(face.triangle, ends[0])] = 1;
    }
    return bad;
  }

  /// No fans at both ends of these edges. Collective.
  void leave_out(const std::vector<std::int32_t>& bad, std::vector<double>& reached) const {
    for (std::size_t e = 0; e < bad.size(); ++e) {
      if (bad[e] == 0) continue;
      const LocalWall::Corners& corners = _in.wall.triangles[e / 3];
      for (const std::size_t i : {e % 3, (e + 1) % 3}) reached[corners[i]] = 0;
    }
    _in.wall.combine(reached, [](double a, double b) { return std::min(a, b); });
  }

  const LayerInput& _in;
  RidgeEdges _ridges;
  std::vector<std::int32_t> _halvings;  // FanNeeds::halvings
};

FittedColumns fit_straight_columns(const LayerInput& in, KnownColumns& known) {
  if (!in.may_have_fans) return limit_columns(in, known, without_fans(in.wall));
  std::vector<double> reached(in.wall.points.size(), std::numeric_limits<double>::infinity());
  SectorHalving halving(in);
  std::optional columns(limit_columns(in, known, halving.find(reached)));
  if (find_low_fans(in, *columns, reached)) {
    Fans fans = halving.find(reached);
    if (have_fewer(in, columns->fans, fans)) columns.emplace(limit_columns(in, known, std::move(fans)));
  }
  if (has_empty_fans(in, *columns)) columns.emplace(limit_columns(in, known, without_fans(in.wall)));
  return std::move(*columns);
}

/// The bends that columns of the heights that straight ones reach are to have.
std::vector<Bend> bends_over(const LayerInput& in, const FittedColumns& straight) {
  std::vector<double> heights(in.wall.points.size(), 0);
  for (std::int32_t v = 0; v < in.wall.vertex_count(); ++v) heights[v] = straight.limits.total(v);
  return find_bends(in.wall, in.stars, straight.fans, {heights, in.edges, straight.directions.smoothed});
}

}  // namespace

FittedColumns fit_columns(const LayerInput& in) {
  KnownColumns known{MeasuredGaps(in.wall), {}};
  FittedColumns straight = fit_straight_columns(in, known);
  if (!in.bends_columns) return straight;
  std::vector<Bend> bends = bends_over(in, straight);
  if (bends.empty()) return straight;
  return limit_columns(in, known, std::move(straight.fans), std::move(bends));
}

}  // namespace aeroloom::layers
