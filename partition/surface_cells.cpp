#include "partition/surface_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <queue>

namespace aeroloom::partition {
namespace {

using geometry::Vec3;
using Sides = std::array<std::int32_t, 3>;

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Distance of seeds, in the metric in which a cell is one wide.
constexpr double seed_distance = 0.8;
constexpr int recentrings = 3;
constexpr int straightenings = 6;

/// The triangle across the edge from corner k to the next one; -1 at the rim, and where more than two meet.
std::vector<Sides> link_triangles(const FinePatch& patch) {
  struct Side {
    std::int32_t low, high, triangle, k;
  };
  std::vector<Side> sides;
  sides.reserve(3 * patch.triangles.size());
  for (std::size_t t = 0; t < patch.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = patch.triangles[t][k], b = patch.triangles[t][(k + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<std::int32_t>(t), k});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& s, const Side& t) {
    return s.low != t.low ? s.low < t.low : s.high != t.high ? s.high < t.high : s.triangle < t.triangle;
  });
  std::vector<Sides> links(patch.triangles.size(), Sides{-1, -1, -1});
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].low == sides[i].low && sides[j].high == sides[i].high) ++j;
    if (j - i != 2) continue;
    links[sides[i].triangle][sides[i].k] = sides[i + 1].triangle;
    links[sides[i + 1].triangle][sides[i + 1].k] = sides[i].triangle;
  }
  return links;
}

class CellGrowth {
public:
  explicit CellGrowth(const FinePatch& patch)
      : _patch(patch), _links(link_triangles(patch)), _cell(patch.triangles.size(), -1) {}

  std::vector<std::int32_t> run(const CellOptions& options) {
    measure_arcs(options);
    std::vector<std::int32_t> seeds = spread_seeds();
    for (int i = 0; i < recentrings; ++i) {
      grow(seeds);
      recentre(seeds);
    }
    grow(seeds);
    straighten();
    while (split([&](std::span<const std::int32_t> cell) { return !is_disk(cell); })) {
    }
    return number_by_first();
  }

  std::vector<std::int32_t> cut(std::vector<std::int32_t> cells, const std::vector<char>& cut) {
    _cell = std::move(cells);
    _cells = static_cast<std::int32_t>(cut.size());
    split([&](std::span<const std::int32_t> cell) { return cut[_cell[cell.front()]] != 0; });
    while (split([&](std::span<const std::int32_t> cell) { return !is_disk(cell); })) {
    }
    return number_by_first();
  }

private:
  struct Reached {
    double distance;
    std::int32_t triangle;
    friend bool operator>(const Reached& a, const Reached& b) {
      return a.distance != b.distance ? a.distance > b.distance : a.triangle > b.triangle;
    }
  };
  using Queue = std::priority_queue<Reached, std::vector<Reached>, std::greater<>>;

  std::int32_t size() const { return static_cast<std::int32_t>(_links.size()); }

  void measure_arcs(const CellOptions& options) {
    const auto count = _patch.triangles.size();
    std::vector<Vec3> centers(count), normals(count);
    std::vector<double> edges(count);
    for (std::size_t t = 0; t < count; ++t) {
      const auto& v = _patch.triangles[t];
      const Vec3 a = _patch.points[v[0]], b = _patch.points[v[1]], c = _patch.points[v[2]];
      centers[t] = (a + b + c) / 3.0;
      normals[t] = normalized(cross(b - a, c - a));
      edges[t] = (distance(a, b) + distance(b, c) + distance(c, a)) / 3;
    }
    const double turn = options.turning * std::numbers::pi / 180;
    _arcs.resize(count);
    for (std::size_t t = 0; t < count; ++t) {
      for (int k = 0; k < 3; ++k) {
        const std::int32_t u = _links[t][k];
        if (u < 0) continue;
        const double length = 2 * distance(centers[t], centers[u]) / (edges[t] + edges[u]);
        const double angle = std::atan2(norm(cross(normals[t], normals[u])), dot(normals[t], normals[u]));
        _arcs[t][k] = length / options.width + angle / turn;
      }
    }
  }

  /// Shortest ways from what is in the queue, up to `range`; `visit(t, from)` is called when a way gets
  /// shorter.
  template <class Visit>
  void walk(Queue& queue, std::vector<double>& distances, double range, const Visit& visit) {
    while (!queue.empty()) {
      const Reached at = queue.top();
      queue.pop();
      if (at.distance > distances[at.triangle]) continue;
      for (int k = 0; k < 3; ++k) {
        const std::int32_t u = _links[at.triangle][k];
        if (u < 0) continue;
        const double there = at.distance + _arcs[at.triangle][k];
        if (there >= distances[u] || there > range) continue;
        distances[u] = there;
        visit(u, at.triangle);
        queue.push({there, u});
      }
    }
  }

  /// A seed wherever none is near, going outwards from those there are, so that they lie densely.
  std::vector<std::int32_t> spread_seeds() {
    std::vector<std::int32_t> seeds;
    std::vector<double> near(_links.size(), infinity);
    for (std::int32_t first = 0; first < size(); ++first) {
      if (near[first] < infinity) continue;
      std::queue<std::int32_t> front;
      front.push(first);
      std::vector<std::int32_t> reached;
      while (!front.empty()) {
        const std::int32_t t = front.front();
        front.pop();
        if (near[t] < infinity) continue;
        seeds.push_back(t);
        near[t] = 0;
        reached.assign(1, t);
        Queue queue;
        queue.push({0, t});
        walk(queue, near, seed_distance, [&](std::int32_t u, std::int32_t) { reached.push_back(u); });
        for (const std::int32_t r : reached) {
          for (const std::int32_t u : _links[r]) {
            if (u >= 0 && near[u] == infinity) front.push(u);
          }
        }
      }
    }
    return seeds;
  }

  void grow(const std::vector<std::int32_t>& seeds) {
    std::vector<double> distances(_links.size(), infinity);
    Queue queue;
    for (std::size_t s = 0; s < seeds.size(); ++s) {
      distances[seeds[s]] = 0;
      _cell[seeds[s]] = static_cast<std::int32_t>(s);
      queue.push({0, seeds[s]});
    }
    _cells = static_cast<std::int32_t>(seeds.size());
    walk(queue, distances, infinity, [&](std::int32_t u, std::int32_t from) { _cell[u] = _cell[from]; });
  }

  /// Moves each seed to the triangle of its cell farthest from the rim of the cell.
  void recentre(std::vector<std::int32_t>& seeds) {
    std::vector<double> distances(_links.size(), infinity);
    Queue queue;
    for (std::int32_t t = 0; t < size(); ++t) {
      const bool rim = std::any_of(_links[t].begin(), _links[t].end(),
                                   [&](std::int32_t u) { return u < 0 || _cell[u] != _cell[t]; });
      if (!rim) continue;
      distances[t] = 0;
      queue.push({0, t});
    }
    walk(queue, distances, infinity, [](std::int32_t, std::int32_t) {});
    std::vector<double> depth(seeds.size(), -1);
    for (std::int32_t t = 0; t < size(); ++t) {
      const double d = distances[t] == infinity ? 0 : distances[t];
      if (d > depth[_cell[t]]) depth[_cell[t]] = d, seeds[_cell[t]] = t;
    }
  }

  /// Gives triangles that jut out into a neighbour to it: two of three edges there, or one of two.
  void straighten() {
    for (int sweep = 0; sweep < straightenings; ++sweep) {
      bool moved = false;
      for (std::int32_t t = 0; t < size(); ++t) {
        const Sides& u = _links[t];
        int own = 0, other = -1;
        for (int k = 0; k < 3; ++k) {
          if (u[k] >= 0 && _cell[u[k]] == _cell[t]) ++own;
        }
        if (own != 1) continue;  // two would cut the cell, none is a cell by itself
        for (int k = 0; k < 3; ++k) {
          const std::int32_t a = u[k], b = u[(k + 1) % 3];
          if (a >= 0 && b >= 0 && _cell[a] == _cell[b] && _cell[a] != _cell[t]) other = _cell[a];
        }
        if (other < 0) continue;
        _cell[t] = other;
        moved = true;
      }
      if (!moved) return;
    }
  }

  /// Cuts the cells chosen in two. False when there were none.
  template <class Choose>
  bool split(const Choose& choose) {
    std::vector<std::int32_t> first(_cells + 1, 0), members(_links.size());
    for (const std::int32_t c : _cell) ++first[c + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::int32_t> next(first.begin(), first.end() - 1);
    for (std::int32_t t = 0; t < size(); ++t) members[next[_cell[t]]++] = t;
    const std::int32_t cells = _cells;
    bool any = false;
    for (std::int32_t c = 0; c < cells; ++c) {
      const std::span<const std::int32_t> cell(members.data() + first[c],
                                               static_cast<std::size_t>(first[c + 1] - first[c]));
      if (cell.size() < 2 || !choose(cell)) continue;
      split_in_two(cell);
      any = true;
    }
    return any;
  }

  bool is_disk(std::span<const std::int32_t> cell) {
    std::vector<std::int32_t> vertices, starts;
    std::size_t inner = 0;
    for (const std::int32_t t : cell) {
      for (int k = 0; k < 3; ++k) {
        vertices.push_back(_patch.triangles[t][k]);
        const std::int32_t u = _links[t][k];
        if (u >= 0 && _cell[u] == _cell[t]) {
          ++inner;
        } else {
          starts.push_back(_patch.triangles[t][k]);
        }
      }
    }
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    std::sort(starts.begin(), starts.end());
    const bool touches = std::adjacent_find(starts.begin(), starts.end()) != starts.end();
    const auto euler = static_cast<std::int64_t>(vertices.size() + cell.size()) -
                       static_cast<std::int64_t>(inner / 2 + starts.size());
    return euler == 1 && !touches && !starts.empty();
  }

  /// Two seeds as far apart as can be found in two walks, and what is nearer to each.
  void split_in_two(std::span<const std::int32_t> cell) {
    const std::int32_t one = farthest_in(cell, cell.front()), two = farthest_in(cell, one);
    const std::int32_t fresh = _cells++, old = _cell[one];
    for (const std::int32_t t : cell) _cell[t] = -1;
    std::queue<std::int32_t> front;
    _cell[one] = old;
    _cell[two] = fresh;
    front.push(one);
    front.push(two);
    _allowed.assign(cell.begin(), cell.end());
    std::sort(_allowed.begin(), _allowed.end());
    while (!front.empty()) {
      const std::int32_t t = front.front();
      front.pop();
      for (const std::int32_t u : _links[t]) {
        if (u < 0 || _cell[u] >= 0 || !std::binary_search(_allowed.begin(), _allowed.end(), u)) continue;
        _cell[u] = _cell[t];
        front.push(u);
      }
    }
  }

  /// The triangle most steps away within the cell; never the start itself.
  std::int32_t farthest_in(std::span<const std::int32_t> cell, std::int32_t start) {
    std::vector<std::int32_t> sorted(cell.begin(), cell.end()), seen;
    std::sort(sorted.begin(), sorted.end());
    std::vector<char> reached(sorted.size(), 0);
    const auto slot = [&](std::int32_t t) {
      const auto at = std::lower_bound(sorted.begin(), sorted.end(), t);
      return at != sorted.end() && *at == t ? at - sorted.begin() : -1;
    };
    seen.push_back(start);
    reached[slot(start)] = 1;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (const std::int32_t u : _links[seen[i]]) {
        const auto s = u < 0 ? -1 : slot(u);
        if (s < 0 || reached[s]) continue;
        reached[s] = 1;
        seen.push_back(u);
      }
    }
    return seen.back();
  }

  std::vector<std::int32_t> number_by_first() const {
    std::vector<std::int32_t> number(_cells, -1), result(_cell.size());
    std::int32_t next = 0;
    for (std::size_t t = 0; t < _cell.size(); ++t) {
      if (number[_cell[t]] < 0) number[_cell[t]] = next++;
      result[t] = number[_cell[t]];
    }
    return result;
  }

  const FinePatch& _patch;
  std::vector<Sides> _links;
  std::vector<std::array<double, 3>> _arcs;
  std::vector<std::int32_t> _cell;
  std::int32_t _cells = 0;
  std::vector<std::int32_t> _allowed;
};

}  // namespace

std::vector<std::int32_t> grow_cells(const FinePatch& patch, const CellOptions& options) {
  return CellGrowth(patch).run(options);
}

std::vector<std::int32_t> cut_cells(const FinePatch& patch, std::vector<std::int32_t> cells,
                                    const std::vector<char>& cut) {
  return CellGrowth(patch).cut(std::move(cells), cut);
}

}  // namespace aeroloom::partition
