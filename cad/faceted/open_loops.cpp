#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/fill_openings.hpp"
#include "geometry/angle.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace aeroloom::cad {
namespace {

/// An end of an open side.
struct SideEnd {
  std::int32_t side = -1, end = 0;
  std::size_t index() const { return 2 * static_cast<std::size_t>(side) + static_cast<std::size_t>(end); }
};

/// Pairs the open sides at each point, as a loop passes it.
class LoopTracer {
public:
  LoopTracer(const FacetSoup& soup, std::span<const OpenSide> sides) : _soup(soup), _sides(sides) {
    _at.resize(soup.points.size());
    for (std::int32_t s = 0; s < static_cast<std::int32_t>(sides.size()); ++s)
      for (std::int32_t e = 0; e < 2; ++e) _at[sides[s].points[e]].push_back({s, e});
    _next.resize(2 * sides.size());
  }

  /// False, with its place, if there is a point with an odd number of sides.
  bool pair(std::int32_t& place) {
    for (std::size_t p = 0; p < _at.size(); ++p) {
      if (_at[p].size() % 2 == 0) continue;
      place = static_cast<std::int32_t>(p);
      return false;
    }
    find_fans();
    for (const std::vector<SideEnd>& ends : _at) {
      if (ends.size() == 2)
        connect(ends[0], ends[1]);
      else if (ends.size() > 2)
        pair_branches(ends);
    }
    return true;
  }

  std::vector<OpenLoop> trace() const {
    std::vector<OpenLoop> loops;
    std::vector<char> used(_sides.size(), 0);
    std::vector<std::int32_t> position(_at.size(), -1);  // in the walk
    for (std::int32_t first = 0; first < static_cast<std::int32_t>(_sides.size()); ++first) {
      std::vector<std::int32_t> walk;
      SideEnd leaving{first, 0};
      while (used[leaving.side] == 0) {
        used[leaving.side] = 1;
        visit(_sides[leaving.side].points[leaving.end], walk, position, loops);
        leaving = _next[SideEnd{leaving.side, 1 - leaving.end}.index()];
      }
      if (!walk.empty()) visit(walk.front(), walk, position, loops);
      for (const std::int32_t p : walk) position[p] = -1;
    }
    return loops;
  }

private:
  /// A point where the walk was before ends a loop.
  static void visit(std::int32_t point, std::vector<std::int32_t>& walk, std::vector<std::int32_t>& position,
                    std::vector<OpenLoop>& loops) {
    if (position[point] >= 0) {
      loops.emplace_back(walk.begin() + position[point], walk.end());
      for (const std::int32_t p : loops.back()) position[p] = -1;
      walk.resize(walk.size() - loops.back().size());
    }
    position[point] = static_cast<std::int32_t>(walk.size());
    walk.push_back(point);
  }

  void connect(SideEnd a, SideEnd b) { _next[a.index()] = b, _next[b.index()] = a; }

  /// Triangles at points of several loops, connected over sides there.
  void find_fans() {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> first_at;  // point, other point: triangle
    _fans = geometry::DisjointSets<std::int32_t>(3 * _soup.triangles.size());
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(_soup.triangles.size()); ++t) {
      for (std::int32_t i = 0; i < 3; ++i) {
        const std::int32_t p = _soup.triangles[t][i];
        if (_at[p].size() <= 2) continue;
        for (const std::int32_t j : {(i + 1) % 3, (i + 2) % 3}) {
          const auto [found, is_new] = first_at.emplace(std::pair(p, _soup.triangles[t][j]), 3 * t + i);
          if (!is_new) _fans.unite(found->second, 3 * t + i);
        }
      }
    }
  }

  std::int32_t fan_of(SideEnd end) {
    const std::int32_t t = _sides[end.side].triangle, p = _sides[end.side].points[end.end];
    for (std::int32_t i = 0; i < 3; ++i)
      if (_soup.triangles[t][i] == p) return _fans.root(3 * t + i);
    return -1;
  }

  Vec3 way_of(SideEnd end) const {
    const auto& points = _sides[end.side].points;
    return _soup.points[points[1 - end.end]] - _soup.points[points[end.end]];
  }

  /// Sides of one opening belong to different fans, and have the smallest angles between them.
  void pair_branches(const std::vector<SideEnd>& ends) {
    std::vector<std::tuple<bool, double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < ends.size(); ++i)
      for (std::size_t j = i + 1; j < ends.size(); ++j)
        pairs.emplace_back(fan_of(ends[i]) == fan_of(ends[j]),
                           geometry::angle_between(way_of(ends[i]), way_of(ends[j])), i, j);
    std::sort(pairs.begin(), pairs.end());
    std::vector<char> paired(ends.size(), 0);
    for (const auto& [same, angle, i, j] : pairs) {
      if (paired[i] != 0 || paired[j] != 0) continue;
      paired[i] = paired[j] = 1;
      connect(ends[i], ends[j]);
    }
  }

  const FacetSoup& _soup;
  std::span<const OpenSide> _sides;
  std::vector<std::vector<SideEnd>> _at;  // of each point
  std::vector<SideEnd> _next;             // of each end
  geometry::DisjointSets<std::int32_t> _fans{0};
};

}  // namespace

std::vector<OpenSide> list_open_sides(const FacetSoup& soup) {
  std::vector<OpenSide> sides;
  for (const geometry::HalfEdge h : open_sides(soup.triangles))
    sides.push_back({{side_begin(soup.triangles, h), side_end(soup.triangles, h)}, facet_of(h)});
  return sides;
}

std::optional<std::vector<OpenLoop>> trace_open_loops(const FacetSoup& soup, std::span<const OpenSide> sides,
                                                      std::int32_t& place) {
  LoopTracer tracer(soup, sides);
  if (!tracer.pair(place)) return std::nullopt;
  return tracer.trace();
}

}  // namespace aeroloom::cad
