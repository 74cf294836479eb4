#include "layers/column_limits.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::layers {
namespace {

/// The largest difference of totals along an edge, over its length. It rises for growths g below 1.2: layers
/// that end isotropic are 0.7 g / (g - 1) edges high, and change over that distance.
double slope_of(double growth) {
  constexpr double ratio_at_1_2 = 6;  // g / (g - 1)
  return std::max(1.0, growth / (growth - 1) / ratio_at_1_2);
}

constexpr auto smaller = [](auto a, auto b) { return std::min(a, b); };

}  // namespace

ColumnLimits::ColumnLimits(const LocalWall& wall, const std::vector<VertexLayers>& all_wanted,
                           const std::vector<FittedLayers>& fitted, const VertexStars& stars,
                           const Directions& directions)
    : _wall(wall) {
  const std::size_t n = all_wanted.size();
  _first.assign(n, 0), _growth.assign(n, 1), _mean_edges.assign(n, 0), _slopes.assign(n, 1),
      _limits.assign(n, 0), _wanted_lasts.assign(n, 0);
  _constant.assign(n, 1), _fitted.assign(n, {}), _causes.assign(n, LayerLimit::none), _changed.assign(n, 0);
  _wanted_counts.assign(n, 0);
  for (std::int32_t v = 0; v < wall.vertex_count(); ++v) {
    const VertexLayers& asked = all_wanted[v];
    if (asked.edges == 0) continue;
    _mean_edges[v] = asked.mean_edge();
    _wanted_counts[v] = fitted[v].count;
    if (stars.kinds[v] != StarKind::plain || directions.visibility[v] == 0) {
      _causes[v] = stars.kinds[v] == StarKind::ending ? LayerLimit::ending : LayerLimit::no_direction;
      _lowered.push_back(v);
      continue;
    }
    _first[v] = asked.first * lengthening_of(directions.slants[v]);
    _growth[v] = asked.growth;
    _constant[v] = static_cast<std::int32_t>(asked.constant);
    _slopes[v] = slope_of(asked.growth);
    _fitted[v] = fitted[v];
    _limits[v] = total(v);
    _wanted_lasts[v] = last_height(v);
    _lowered.push_back(v);
    note_change(v, LayerLimit::none);
  }
}

void ColumnLimits::note_change(std::int32_t v, LayerLimit cause) {
  _causes[v] = cause;
  if (_changed[v] == 0) _changed_vertices.push_back(v);
  _changed[v] = 1;
}

std::vector<std::int32_t> ColumnLimits::take_changed() {
  for (const std::int32_t v : _changed_vertices) _changed[v] = 0;
  return std::exchange(_changed_vertices, {});
}

void ColumnLimits::cut_count(std::int32_t v, std::int32_t count, LayerLimit cause) {
  _fitted[v] = {count};
  _limits[v] = std::min(_limits[v], total(v));
  _lowered.push_back(v);
  note_change(v, cause);
}

void ColumnLimits::fit(std::int32_t v, LayerLimit cause) {
  const FittedLayers fitted = fit_layers(regular_heights(v), count(v), _limits[v], _wanted_lasts[v]);
  if (fitted == _fitted[v]) return;
  _fitted[v] = fitted;
  note_change(v, cause);
}

void ColumnLimits::limit_totals(std::vector<double> limits, LayerLimit cause) {
  _wall.combine(limits, smaller);
  for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
    if (!(limits[v] < _limits[v])) continue;
    _limits[v] = limits[v];
    _lowered.push_back(v);
    fit(v, cause);
  }
}

void ColumnLimits::limit_counts(std::vector<std::int32_t> counts, LayerLimit cause) {
  _wall.combine(counts, smaller);
  for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
    if (counts[v] < count(v)) cut_count(v, counts[v], cause);
  }
}

void ColumnLimits::lower_by_slopes(std::vector<double>& limits, std::vector<std::int32_t> from) const {
  std::vector<std::uint8_t> waits(limits.size(), 0);
  std::vector<std::int32_t> next;
  const auto lower = [&](std::int32_t v, double limit) {
    if (!(limit < limits[v])) return;
    limits[v] = limit;
    if (waits[v] == 0) next.push_back(v);
    waits[v] = 1;
  };
  for (bool changes = true; changes;) {
    while (!from.empty()) {
      for (const std::int32_t v : from) waits[v] = 0;
      for (const std::int32_t v : from) {
        _wall.for_each_neighbour(v, [&](std::int32_t u) {
          lower(u, limits[v] + _slopes[u] * distance(_wall.points[u], _wall.points[v]));
        });
      }
      from.swap(next);
      next.clear();
    }
    std::vector<double> combined = limits;
    _wall.combine(combined, smaller);
    for (const std::int32_t v : _wall.vertex_of_copy) lower(v, combined[v]);
    from.swap(next);
    next.clear();
    changes = _wall.mesh.communicator.sum(static_cast<std::int64_t>(from.size())) > 0;
  }
}

void ColumnLimits::converge() {
  std::vector<double> limits = _limits;
  lower_by_slopes(limits, std::exchange(_lowered, {}));
  for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
    if (!(limits[v] < _limits[v])) continue;
    _limits[v] = limits[v];
    fit(v, LayerLimit::slope);
  }
}

}  // namespace aeroloom::layers
