#include "layers/sectors.hpp"

#include "geometry/disjoint_sets.hpp"
#include "layers/column_heights.hpp"
#include "layers/end_planes.hpp"
#include "mesh/data/shared_vertex_keys.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

/// Wider ones are flat triangles, invalid where the fans of neighbours are twisted. Chosen, not measured.
constexpr double widest_sector = 35 * std::numbers::pi / 180, widest_of_all = 75 * std::numbers::pi / 180;
/// Keys of columns have eight bits for their number; a corner of three ridges has about as many columns as a
/// disc around which 60 sectors lie.
constexpr std::int32_t most_sectors = 24, most_columns = 255;
/// At the ends of columns, in edges; chosen: with one edge a coarse wing had twice the cells, and no better
/// ones.
constexpr double widest_end = 2.5, narrowest_end = 0.3;
/// Edges from the end of a fan to where a ridge is longest; chosen, not measured.
constexpr std::int32_t least_depth = 2;
constexpr auto more = [](auto a, auto b) { return std::max(a, b); };
constexpr auto fewer = [](auto a, auto b) { return std::min(a, b); };

std::int32_t sectors_by_turn(double turn, double widest) {
  return static_cast<std::int32_t>(std::clamp(std::ceil(turn / widest), 1.0, double{most_sectors}));
}
std::int32_t least_at(double turn) {
  return sectors_by_turn(turn, widest_of_all);
}
std::int32_t sectors_by_front(double turn, double height, double width) {
  return static_cast<std::int32_t>(std::clamp(std::ceil(turn * height / width), 1.0, double{most_sectors}));
}

class SectorCounter {
public:
  SectorCounter(const LocalWall& wall, const VertexStars& stars, const FanNeeds& needs)
      : _wall(wall),
        _stars(stars),
        _wanted(needs.wanted),
        _fitted(needs.fitted),
        _ridges(needs.ridges),
        _edges(needs.edges),
        _reached(needs.reached),
        _halvings(needs.halvings),
        _names(wall.vertex_names()) {
    for (std::int32_t v = 0; v < wall.vertex_count(); ++v) {
      const Ridge* ridge = stars.ridge_at(v);
      _first_place.push_back(_first_place.back() +
                             (ridge == nullptr ? 0 : static_cast<std::int32_t>(ridge->edges.size())));
    }
  }

  Sectors count() {
    ask();
    drop_low();
    drop_short();
    agree_along_ridges(more);
    halve();
    agree_along_ridges(fewer);
    make_fans();
    mark_ends();
    return std::move(_sectors);
  }

private:
  void ask() {
    std::size_t most_slots = 2;
    for (const Ridge& ridge : _stars.ridges) most_slots = std::max(most_slots, ridge.edges.size());
    const auto slots =
        static_cast<std::size_t>(_wall.mesh.communicator.maximum(static_cast<std::int64_t>(most_slots)));
    _by_slot.assign(slots, std::vector<std::int32_t>(_wall.points.size(), 0));
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
      const Ridge* ridge = _stars.ridge_at(v);
      if (ridge == nullptr || _wanted[v].edges == 0 || _edges[v] <= 0) continue;
      if (_names[v].piece < 0 && !mesh::can_name_columns(_names[v].id)) continue;
      const double height = wanted_height(_wanted[v], _fitted[v]);
      for (std::size_t e = 0; e < ridge->edges.size(); ++e) {
        const double turn = turn_at(*ridge, e);
        _by_slot[e][v] =
            std::min(wanted_sectors(turn, height, _ridges.lengths[v]),
                     std::max(least_at(turn),
                              sectors_by_front(turn, _reached[v], narrowest_end * _ridges.lengths[v])));
      }
    }
  }

  /// Removes fans that are low, but those of one or two vertices between others: where fans end there are no
  /// layers, and they would end at all of these.
  void drop_low() {
    enum : std::int32_t { none, lone, low, beside, full };
    std::vector<std::int32_t> states(_wall.points.size(), none);
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
      if (fans_at(v) > 0 && _reached[v] > 0) states[v] = is_low(v) ? low : full;
    }
    const auto is_full = [](std::int32_t state) { return state == full; };
    const auto is_dropped = [](std::int32_t state) { return state < beside; };
    const auto pass = [&](std::int32_t from, std::int32_t to, const auto& is_beside, const auto& op) {
      std::vector<std::int32_t> after = states;
      for (const RidgeEdge& edge : _ridges.edges) {
        for (int end = 0; end < 2; ++end) {
          std::int32_t& state = after[edge.ends[end]];
          if (state == from && is_beside(states[edge.ends[1 - end]])) state = to;
        }
      }
      _wall.combine(after, op);
      states = std::move(after);
    };
    pass(low, beside, is_full, more);
    pass(beside, lone, is_dropped, fewer);
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
      if (states[v] < beside) drop(v);
    }
  }

  /// Whether even the fewest sectors would be narrow at the ends of columns: tetrahedra on them are flat.
  bool is_low(std::int32_t v) const {
    const Ridge& ridge = *_stars.ridge_at(v);
    double widest = 0;
    for (std::size_t e = 0; e < ridge.edges.size(); ++e) {
      const double turn = turn_at(ridge, e);
      widest = std::max(widest, turn * _reached[v] / least_at(turn));
    }
    return widest < narrowest_end * _ridges.lengths[v];
  }

  static double turn_at(const Ridge& ridge, std::size_t edge) {
    return ridge.turns[ridge.is_corner() ? edge : 0].angle;
  }
  std::int32_t& count_of(std::int32_t vertex, std::int32_t slot) { return _by_slot[slot][vertex]; }
  bool has_fan(const RidgeEdge& edge, int end) const {
    return edge.slots[end] >= 0 && _by_slot[edge.slots[end]][edge.ends[end]] > 0;
  }
  /// Along a ridge that passes, both edges.
  void set(std::int32_t vertex, std::int32_t slot, std::int32_t count) {
    const Ridge& ridge = *_stars.ridge_at(vertex);
    if (ridge.is_corner()) {
      count_of(vertex, slot) = count;
      return;
    }
    for (std::size_t e = 0; e < ridge.edges.size(); ++e) _by_slot[e][vertex] = count;
  }

  std::int32_t& fans_at(std::int32_t v) { return _by_slot[0][v]; }
  void drop(std::int32_t v) {
    for (std::vector<std::int32_t>& counts : _by_slot) counts[v] = 0;
  }
  /// Whether sectors over an edge end at one of its ends, where there is no fan or one of other edges alone.
  bool ends_at(const RidgeEdge& edge, int end) const { return has_fan(edge, 1 - end) && !has_fan(edge, end); }

  /// Calls pass() until it returns that it changed nothing, here and, once what it changes is combined, on
  /// all ranks. Values of vertices are equal in all pieces: where no pass changes any, combining changes
  /// none.
  template <class Pass, class Combine>
  void repeat(const Pass& pass, const Combine& combine) const {
    for (;;) {
      bool changed = false;
      while (pass()) changed = true;
      if (_wall.mesh.communicator.sum(std::int64_t{changed}) == 0) return;
      combine();
    }
  }
  template <class Op>
  void combine_counts(const Op& op) {
    for (std::vector<std::int32_t>& counts : _by_slot) _wall.combine(counts, op);
  }

  /// Removes the fans of vertices at which those of another edge end. Collective.
  void drop_beside_ends() {
    const auto pass = [&] {
      bool changed = false;
      for (const RidgeEdge& edge : _ridges.edges) {
        for (int end = 0; end < 2; ++end) {
          const std::int32_t v = edge.ends[end];
          if (!ends_at(edge, end) || fans_at(v) == 0) continue;
          drop(v);
          changed = true;
        }
      }
      return changed;
    };
    repeat(pass, [&] { combine_counts(fewer); });
  }

  /// Removes those, and fans of ridges that are short: nowhere some edges away from such an end. Collective.
  void drop_short() {
    for (bool changes = true; changes;) {
      drop_beside_ends();
      std::vector<std::int32_t> depths(_wall.points.size(), 0);
      for (std::size_t v = 0; v < depths.size(); ++v) depths[v] = _by_slot[0][v] > 0 ? least_depth : 0;
      measure_depths(depths);
      raise_along_fans(depths);
      std::int64_t dropped = 0;
      for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
        if (fans_at(v) == 0 || depths[v] >= least_depth) continue;
        drop(v);
        ++dropped;
      }
      changes = _wall.mesh.communicator.sum(dropped) > 0;
    }
  }

  /// Lowers the depths of fans to one more than those beside them, at an end or a fan. Collective.
  void measure_depths(std::vector<std::int32_t>& depths) const {
    const auto pass = [&] {
      bool changed = false;
      for (const RidgeEdge& edge : _ridges.edges) {
        for (int end = 0; end < 2; ++end) {
          std::int32_t& here = depths[edge.ends[end]];
          const std::int32_t beside = depths[edge.ends[1 - end]] + 1;
          if (!has_fan(edge, end) || here <= beside) continue;
          here = beside;
          changed = true;
        }
      }
      return changed;
    };
    repeat(pass, [&] { _wall.combine(depths, fewer); });
  }

  /// Raises values to the largest that edges from fan to fan lead to. Collective.
  void raise_along_fans(std::vector<std::int32_t>& values) const {
    geometry::DisjointSets<std::int32_t> sets(values.size());
    for (const RidgeEdge& edge : _ridges.edges) {
      if (has_fan(edge, 0) && has_fan(edge, 1)) sets.unite(edge.ends[0], edge.ends[1]);
    }
    const auto pass = [&] {
      std::vector<std::int32_t> most = values;
      for (std::int32_t v = 0; v < _wall.vertex_count(); ++v)
        most[sets.root(v)] = std::max(most[sets.root(v)], values[v]);
      bool changed = false;
      for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
        changed = changed || values[v] < most[sets.root(v)];
        values[v] = most[sets.root(v)];
      }
      return changed;
    };
    repeat(pass, [&] { _wall.combine(values, more); });
  }

  void mark_ends() {
    _sectors.is_end.assign(_wall.points.size(), 0);
    for (const RidgeEdge& edge : _ridges.edges) {
      for (int end = 0; end < 2; ++end) {
        if (ends_at(edge, end)) _sectors.is_end[edge.ends[end]] = 1;
      }
    }
    _wall.combine(_sectors.is_end, more);
  }

  /// All edges of a ridge as many as that with most, or with fewest. Collective.
  template <class Op>
  void agree_along_ridges(const Op& op) {
    geometry::DisjointSets<std::int32_t> sets(static_cast<std::size_t>(_first_place.back()));
    const auto place = [&](std::int32_t v, std::int32_t slot) { return _first_place[v] + slot; };
    for (const RidgeEdge& edge : _ridges.edges) {
      if (has_fan(edge, 0) && has_fan(edge, 1))
        sets.unite(place(edge.ends[0], edge.slots[0]), place(edge.ends[1], edge.slots[1]));
    }
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
      if (_first_place[v] == _first_place[v + 1] || _stars.ridge_at(v)->is_corner()) continue;
      for (std::int32_t p = place(v, 1); p < _first_place[v + 1]; ++p) sets.unite(place(v, 0), p);
    }
    const auto for_each_count = [&](const auto& visit) {
      for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
        for (std::int32_t p = _first_place[v]; p < _first_place[v + 1]; ++p)
          visit(sets.root(p), count_of(v, p - _first_place[v]));
      }
    };
    const auto pass = [&] {
      constexpr std::int32_t unknown = -1;
      std::vector<std::int32_t> agreed(sets.size(), unknown);
      for_each_count([&](std::int32_t set, std::int32_t count) {
        agreed[set] = agreed[set] == unknown ? count : op(agreed[set], count);
      });
      bool changed = false;
      for_each_count([&](std::int32_t set, std::int32_t& count) {
        changed = changed || count != agreed[set];
        count = agreed[set];
      });
      return changed;
    };
    repeat(pass, [&] { combine_counts(op); });
  }

  /// Halves numbers where they are to be fewer, down to the least.
  void halve() {
    const std::vector<std::vector<std::int32_t>> before = _by_slot;
    for (const RidgeEdge& edge : _ridges.edges) {
      const std::int32_t halvings = _halvings[3 * static_cast<std::size_t>(edge.triangle) +
                                              _wall.corner_of(edge.triangle, edge.ends[0])];
      if (halvings == 0) continue;
      for (int end = 0; end < 2; ++end) {
        if (!has_fan(edge, end)) continue;
        const std::int32_t v = edge.ends[end], slot = edge.slots[end];
        const std::int32_t least = std::min(before[slot][v], least_at(turn_at(*_stars.ridge_at(v), slot)));
        std::int32_t count = before[slot][v];
        for (std::int32_t i = 0; i < halvings; ++i) count = halved(count);
        set(v, slot, std::min(count_of(v, slot), std::max(count, least)));
      }
    }
    combine_counts(fewer);
  }

  static std::int32_t halved(std::int32_t count) { return (count + 1) / 2; }

  /// Where columns of a vertex cannot see each other, fans end.
  void make_fans() {
    for (std::int64_t failed = 1; failed > 0;) {
      _sectors.fans.clear();
      failed = 0;
      for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) failed += make_fan(v) ? 0 : 1;
      failed = _wall.mesh.communicator.sum(failed);
      if (failed > 0) drop_short();
    }
  }

  bool make_fan(std::int32_t v) {
    const Ridge* ridge = _stars.ridge_at(v);
    if (ridge == nullptr || _by_slot[0][v] == 0) return true;
    std::vector<std::int32_t> sectors;
    for (std::size_t e = 0; e < ridge->edges.size(); ++e) sectors.push_back(_by_slot[e][v]);
    std::optional<VertexFan> fan = make_vertex_fan(*ridge, sectors);
    if (!fan || static_cast<std::int32_t>(fan->directions.size()) > most_columns) {
      drop(v);
      return false;
    }
    if (ridge->on_plane) {
      for (Vec3& direction : fan->directions) direction = along_planes(direction, _stars.planes_at(v));
    }
    if (ridge->half_side >= 0) {
      Vec3& last = fan->directions[fan->of_side[ridge->half_side]];
      last = along_planes(last, _stars.planes_at(v));
    }
    _sectors.fans.emplace(v, std::move(*fan));
    return true;
  }

  const LocalWall& _wall;
  const VertexStars& _stars;
  const std::vector<VertexLayers>& _wanted;
  const std::vector<FittedLayers>& _fitted;
  const RidgeEdges& _ridges;
  const std::vector<double>&_edges, &_reached;
  const std::vector<std::int32_t>& _halvings;
  std::vector<mesh::VertexName> _names;
  /// By place among Ridge::edges and by vertex: the number over that edge; 0: no fan.
  std::vector<std::vector<std::int32_t>> _by_slot;
  std::vector<std::int32_t> _first_place{0};  // by vertex and slot of its ridge's edges
  Sectors _sectors;
};

}  // namespace

std::int32_t wanted_sectors(double turn, double height, double edge) {
  return std::max(sectors_by_turn(turn, widest_sector), sectors_by_front(turn, height, widest_end * edge));
}

Sectors count_sectors(const LocalWall& wall, const VertexStars& stars, const FanNeeds& needs) {
  return SectorCounter(wall, stars, needs).count();
}

}  // namespace aeroloom::layers
