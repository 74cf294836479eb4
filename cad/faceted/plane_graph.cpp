#include "cad/faceted/plane_graph.hpp"

#include "geometry/disjoint_sets.hpp"
#include "geometry/predicates.hpp"
#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace aeroloom::cad {
namespace {

using geometry::orient2d;
using geometry::Vec2;
using Side = std::array<std::int32_t, 2>;

bool lies_before(Vec2 a, Vec2 b) {
  return a.x != b.x ? a.x < b.x : a.y < b.y;
}

/// Whether p, on the line through a and b, lies between them or on one of them.
bool is_between(Vec2 a, Vec2 b, Vec2 p) {
  return !lies_before(p, std::min(a, b, lies_before)) && !lies_before(std::max(a, b, lies_before), p);
}

/// Whether two sides have a point in common that is not an end of both.
bool sides_conflict(std::span<const Vec2> places, Side s, Side t) {
  const Vec2 a = places[s[0]], b = places[s[1]], c = places[t[0]], d = places[t[1]];
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      if (s[i] != t[j]) continue;
      const Vec2 end = places[s[i]], p = places[s[1 - i]], q = places[t[1 - j]];
      return orient2d(end, p, q) == 0 && (is_between(end, p, q) || is_between(end, q, p));
    }
  }
  const int abc = orient2d(a, b, c), abd = orient2d(a, b, d);
  const int cda = orient2d(c, d, a), cdb = orient2d(c, d, b);
  if (abc * abd < 0 && cda * cdb < 0) return true;
  return (abc == 0 && is_between(a, b, c)) || (abd == 0 && is_between(a, b, d)) ||
         (cda == 0 && is_between(c, d, a)) || (cdb == 0 && is_between(c, d, b));
}

/// The graph with bridges, its half-edges around each place, the spaces between them.
class SpaceFinder {
public:
  explicit SpaceFinder(const PlaneGraph& graph) : _graph(graph), _places(graph.places), _sides(graph.sides) {}

  std::optional<std::vector<geometry::TriangleCorners>> fill() {
    for (Side& side : _sides) {
      if (side[0] > side[1]) std::swap(side[0], side[1]);
    }
    geometry::sort_unique(_sides);
    if (std::any_of(_sides.begin(), _sides.end(), [](Side s) { return s[0] == s[1]; })) return {};
    if (_sides.size() < 3 || any_conflict()) return {};
    _real_sides = _sides.size();
    if (!build_bridges()) return {};
    sort_around_places();
    trace_loops();
    decide_spaces();
    std::vector<geometry::TriangleCorners> triangles;
    for (std::size_t l = 0; l < _loops.size(); ++l) {
      if (!_filled[l]) continue;
      const auto ears = cut_ears(_loops[l], _places);
      if (!ears) return {};
      triangles.insert(triangles.end(), ears->begin(), ears->end());
    }
    return triangles;
  }

private:
  bool any_conflict() const {
    std::vector<std::int32_t> order(_sides.size());
    std::iota(order.begin(), order.end(), 0);
    const auto low = [&](std::int32_t s) {
      return std::min(_places[_sides[s][0]].x, _places[_sides[s][1]].x);
    };
    const auto high = [&](std::int32_t s) {
      return std::max(_places[_sides[s][0]].x, _places[_sides[s][1]].x);
    };
    std::ranges::sort(
        order, [&](std::int32_t a, std::int32_t b) { return low(a) != low(b) ? low(a) < low(b) : a < b; });
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = i + 1; j < order.size() && low(order[j]) <= high(order[i]); ++j) {
        if (sides_conflict(_places, _sides[order[i]], _sides[order[j]])) return true;
      }
    }
    return false;
  }

  /// Joins every part to a place before its first one, the nearest that can be seen from there.
  bool build_bridges() {
    geometry::DisjointSets<std::int32_t> parts(_places.size());
    std::vector<std::int32_t> used;
    for (const Side side : _sides) {
      parts.unite(side[0], side[1]);
      used.insert(used.end(), side.begin(), side.end());
    }
    geometry::sort_unique(used, [&](std::int32_t a, std::int32_t b) {
      const Vec2 p = _places[a], q = _places[b];
      return p == q ? a < b : lies_before(p, q);
    });
    for (std::size_t i = 1; i < used.size(); ++i) {
      // Bridges go back in this order, so a part that is not yet joined meets its first place first.
      if (_places[used[i]] == _places[used[i - 1]]) return false;
      if (parts.root(used[i]) == parts.root(used[0])) continue;
      std::vector<std::int32_t> before(used.begin(), used.begin() + static_cast<std::ptrdiff_t>(i));
      const Vec2 here = _places[used[i]];
      std::ranges::stable_sort(before, [&](std::int32_t a, std::int32_t b) {
        return distance(_places[a], here) < distance(_places[b], here);
      });
      const auto seen = std::ranges::find_if(before, [&](std::int32_t b) {
        return std::ranges::none_of(_sides, [&](Side s) { return sides_conflict(_places, s, {b, used[i]}); });
      });
      if (seen == before.end()) return false;
      _sides.push_back({*seen, used[i]});
      parts.unite(*seen, used[i]);
    }
    _first_place = used[0];
    return true;
  }

  // Half-edge 2 s runs along side s, 2 s + 1 against it.
  std::int32_t origin(std::int32_t h) const { return _sides[h / 2][h % 2]; }
  std::int32_t target(std::int32_t h) const { return _sides[h / 2][1 - h % 2]; }

  /// Half-edges that leave each place, counter-clockwise from straight down.
  void sort_around_places() {
    _leaving.resize(_places.size());
    for (std::int32_t h = 0; h < static_cast<std::int32_t>(2 * _sides.size()); ++h)
      _leaving[origin(h)].push_back(h);
    for (std::vector<std::int32_t>& around : _leaving) {
      std::ranges::sort(around, [&](std::int32_t g, std::int32_t h) {
        const Vec2 center = _places[origin(g)], a = _places[target(g)], b = _places[target(h)];
        const bool a_is_left = lies_before(a, center), b_is_left = lies_before(b, center);
        if (a_is_left != b_is_left) return b_is_left;
        return orient2d(center, a, b) > 0;
      });
    }
  }

  /// Loops with their space on the left. That of the outside leaves the first place along the half-edge that
  /// is lowest there.
  void trace_loops() {
    std::vector<std::int32_t> next(2 * _sides.size());
    for (const std::vector<std::int32_t>& around : _leaving) {
      // After h, which comes in, the one that lies next clockwise from its twin.
      for (std::size_t i = 0; i < around.size(); ++i)
        next[around[i] ^ 1] = around[(i + around.size() - 1) % around.size()];
    }
    _loop_of.assign(next.size(), -1);
    for (std::size_t start = 0; start < next.size(); ++start) {
      if (_loop_of[start] >= 0) continue;
      const auto number = static_cast<std::int32_t>(_loops.size());
      std::vector<std::int32_t>& loop = _loops.emplace_back();
      for (auto h = static_cast<std::int32_t>(start); _loop_of[h] < 0; h = next[h]) {
        _loop_of[h] = number;
        loop.push_back(origin(h));
      }
    }
    _outside = _loop_of[_leaving[_first_place].back()];
  }

  void decide_spaces() {
    _filled.assign(_loops.size(), true);
    if (_graph.filling == PlaneFilling::alternating) {
      std::vector<int> depth(_loops.size(), -1);
      std::vector<std::int32_t> reached = {_outside};
      depth[_outside] = 0;
      while (!reached.empty()) {
        const std::int32_t loop = reached.back();
        reached.pop_back();
        for (std::size_t h = 0; h < _loop_of.size(); ++h) {
          const std::int32_t beyond = _loop_of[h ^ 1];
          if (_loop_of[h] != loop || depth[beyond] >= 0) continue;
          depth[beyond] = depth[loop] + (h / 2 < _real_sides ? 1 : 0);
          reached.push_back(beyond);
        }
      }
      for (std::size_t l = 0; l < _loops.size(); ++l) _filled[l] = depth[l] % 2 != 0;
    }
    _filled[_outside] = false;
    for (const Vec2 hole : _graph.holes) {
      for (std::size_t l = 0; l < _loops.size(); ++l) {
        if (_filled[l] && encloses(_loops[l], hole)) _filled[l] = false;
      }
    }
  }

  bool encloses(const std::vector<std::int32_t>& loop, Vec2 p) const {
    bool inside = false;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec2 a = _places[loop[i]], b = _places[loop[(i + 1) % loop.size()]];
      if ((a.y > p.y) == (b.y > p.y)) continue;
      if ((orient2d(a, b, p) > 0) == (b.y > a.y)) inside = !inside;
    }
    return inside;
  }

  const PlaneGraph& _graph;
  std::span<const Vec2> _places;
  std::vector<Side> _sides;  // those of the graph, then bridges
  std::size_t _real_sides = 0;
  std::int32_t _first_place = 0, _outside = 0;
  std::vector<std::vector<std::int32_t>> _leaving, _loops;
  std::vector<std::int32_t> _loop_of;  // of each half-edge
  std::vector<bool> _filled;           // loops
};

}  // namespace

std::optional<std::vector<geometry::TriangleCorners>> fill_plane_graph(const PlaneGraph& graph) {
  return SpaceFinder(graph).fill();
}

}  // namespace aeroloom::cad
