#include "cad/faceted/features.hpp"

#include "geometry/angle.hpp"
#include "geometry/disjoint_sets.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace aeroloom::cad {
namespace {

/// Open chains are noise when they are shorter than so many sides of their surroundings and turn by less than
/// so many times the limit, in the mean. Chosen on scans and on coarse files of CAD.
struct SpurLimit {
  double sides, turns;
};
constexpr SpurLimit spur_limits[] = {{8, 1.35}, {4, 1.8}};
/// Features go on over sides that turn by more than this fraction of the limit, where the chain itself turns
/// by less than `straight`.
constexpr double weak_fraction = 0.5, straight = 50 * geometry::degree;

/// Faces of so few triangles are noise or strips of a coarse cylinder: where they have one neighbour only,
/// they join it if they turn by less than `island_turns` times the limit, and two of them join each other
/// below `strip_turns`. Chosen: an octagon turns by 45 degrees, a hexagon by 60.
constexpr int island_triangles = 3, strip_triangles = 4, face_rounds = 4;
constexpr double island_turns = 2, strip_turns = 1.3;
/// A triangle that is lower than this fraction of its longest side is no face of its own: it joins the
/// neighbour to which it turns least, as an island does. Where it turns to all neighbours by more than
/// `folded`, it lies folded between them and joins one too: edges of bodies, blunt ones included, turn less.
constexpr double lowest_face = 0.05, folded = 120 * geometry::degree;

enum SideState : char { smooth_side = 0, sharp_side = 1, forced_side = 2 };

class FeatureFinder {
public:
  FeatureFinder(const FacetSoup& soup, const std::vector<FacetRegions>& regions, const SideTable& table,
                double angle)
      : _soup(soup), _regions(regions), _table(table), _angle(angle), _turns(measure_turns(soup, table)) {}

  FacetFeatures find() {
    list_sides_at_points();
    mark_sides();
    separate_fans();
    drop_spurs();
    extend_open_ends();
    for (int round = 0; round < face_rounds; ++round) {
      if (!join_small_faces()) break;
      drop_spurs();
    }
    drop_spurs();
    return {std::vector<char>(_state.begin(), _state.end()), find_vertices()};
  }

private:
  Vec3 point(std::int32_t p) const { return _soup.points[p]; }
  bool is_feature(std::int32_t s) const { return _state[s] != smooth_side; }
  double length(std::int32_t s) const {
    return distance(point(_table.sides[s].low), point(_table.sides[s].high));
  }
  std::int32_t other_end(std::int32_t s, std::int32_t p) const {
    return _table.sides[s].low == p ? _table.sides[s].high : _table.sides[s].low;
  }
  std::span<const std::int32_t> sides_at(std::int32_t p) const {
    return {_sides_at.data() + _first_at[p], _sides_at.data() + _first_at[p + 1]};
  }
  int degree(std::int32_t p) const {
    const auto at = sides_at(p);
    return static_cast<int>(
        std::count_if(at.begin(), at.end(), [&](std::int32_t s) { return is_feature(s); }));
  }

  void list_sides_at_points() {
    _first_at.assign(_soup.points.size() + 1, 0);
    for (const SideRecord& side : _table.sides) ++_first_at[side.low + 1], ++_first_at[side.high + 1];
    std::partial_sum(_first_at.begin(), _first_at.end(), _first_at.begin());
    _sides_at.resize(_first_at.back());
    std::vector<std::int32_t> next(_first_at.begin(), _first_at.end() - 1);
    for (std::int32_t s = 0; s < static_cast<std::int32_t>(_table.sides.size()); ++s) {
      _sides_at[next[_table.sides[s].low]++] = s;
      _sides_at[next[_table.sides[s].high]++] = s;
    }
  }

  void mark_sides() {
    _state.assign(_table.sides.size(), smooth_side);
    for (std::size_t s = 0; s < _state.size(); ++s) {
      const SideRecord& side = _table.sides[s];
      const std::int32_t a = facet_of(_table.passes[side.begin].half_edge);
      const std::int32_t b = facet_of(_table.passes[side.end - 1].half_edge);
      if (side.passes() != 2 || _regions[a] != _regions[b] || _soup.group_of[a] != _soup.group_of[b]) {
        _state[s] = forced_side;
      } else if (_turns[s] > _angle) {
        _state[s] = sharp_side;
      }
    }
  }

  /// Where several fans of triangles touch in a point, the point becomes a vertex of each: one of the sides
  /// of a fan without features there is a feature.
  void separate_fans() {
    std::vector<std::vector<geometry::HalfEdge>> corners_at(_soup.points.size());
    for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(_table.side_of.size()); ++h)
      corners_at[side_begin(_soup.triangles, h)].push_back(h);
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(corners_at.size()); ++p) {
      const std::span<const std::int32_t> sides = sides_at(p);
      const auto place = [&](std::int32_t s) {
        return static_cast<std::int32_t>(std::lower_bound(sides.begin(), sides.end(), s) - sides.begin());
      };
      geometry::DisjointSets<std::int32_t> fans(sides.size());
      for (const geometry::HalfEdge h : corners_at[p])
        fans.unite(place(_table.side_of[h]), place(_table.side_of[geometry::previous_half_edge(h)]));
      std::vector<char> has_feature(sides.size(), 0);
      std::size_t count = 0;
      for (std::size_t i = 0; i < sides.size(); ++i) {
        const std::int32_t root = fans.root(static_cast<std::int32_t>(i));
        count += root == static_cast<std::int32_t>(i);
        if (_state[sides[i]] == forced_side) has_feature[root] = 1;
      }
      if (count < 2) continue;
      _touching.push_back(p);
      for (std::size_t i = 0; i < sides.size(); ++i) {
        if (fans.root(static_cast<std::int32_t>(i)) == static_cast<std::int32_t>(i) && has_feature[i] == 0)
          _state[sides[i]] = forced_side;
      }
    }
  }

  /// A chain of features from a point over points where two of them meet.
  struct Chain {
    std::vector<std::int32_t> sides;
    std::int32_t begin = -1, end = -1;
  };

  Chain follow(std::int32_t begin, std::int32_t side) const {
    Chain chain{{side}, begin, other_end(side, begin)};
    while (chain.end != begin && degree(chain.end) == 2) {
      std::int32_t next = -1;
      for (const std::int32_t s : sides_at(chain.end)) {
        if (is_feature(s) && s != chain.sides.back()) next = s;
      }
      chain.sides.push_back(next);
      chain.end = other_end(next, chain.end);
    }
    return chain;
  }

  bool is_noise(const Chain& chain) const {
    double sum = 0, turn = 0, around = 0;
    std::size_t count = 0;
    for (const std::int32_t s : chain.sides) {
      if (_state[s] == forced_side) return false;
      sum += length(s);
      turn += length(s) * _turns[s];
      for (const std::int32_t p : {_table.sides[s].low, _table.sides[s].high}) {
        for (const std::int32_t near : sides_at(p)) around += length(near), ++count;
      }
    }
    around /= static_cast<double>(count);
    return std::any_of(std::begin(spur_limits), std::end(spur_limits), [&](const SpurLimit& limit) {
      return sum < limit.sides * around && turn < limit.turns * _angle * sum;
    });
  }

  /// Until none is left: what a spur ends in may be a spur without it.
  void drop_spurs() {
    std::vector<std::int32_t> ends = open_ends();
    while (!ends.empty()) {
      std::vector<std::int32_t> next;
      for (const std::int32_t p : ends) {
        if (degree(p) != 1) continue;
        const auto at = sides_at(p);
        const std::int32_t side =
            *std::find_if(at.begin(), at.end(), [&](std::int32_t s) { return is_feature(s); });
        const Chain chain = follow(p, side);
        if (!is_noise(chain)) continue;
        for (const std::int32_t s : chain.sides) _state[s] = smooth_side;
        next.push_back(chain.end);
      }
      ends = std::move(next);
    }
  }

  std::vector<std::int32_t> open_ends() const {
    std::vector<std::int32_t> ends;
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(_soup.points.size()); ++p) {
      if (degree(p) == 1) ends.push_back(p);
    }
    return ends;
  }

  /// Goes on from each open end along the sharpest sides ahead; kept where that leads to another feature.
  void extend_open_ends() {
    std::vector<char> on_way(_soup.points.size(), 0);
    for (const std::int32_t begin : open_ends()) {
      if (degree(begin) != 1) continue;
      std::vector<std::int32_t> way, points = {begin};
      std::int32_t at = begin, last = -1;
      for (const std::int32_t s : sides_at(begin)) {
        if (is_feature(s)) last = s;
      }
      bool arrived = false;
      on_way[begin] = 1;
      while (!arrived) {
        const std::int32_t next = sharpest_ahead(at, last);
        if (next < 0 || on_way[other_end(next, at)] != 0) break;
        way.push_back(next);
        at = other_end(next, at), last = next;
        points.push_back(at);
        on_way[at] = 1;
        arrived = degree(at) > 0;
      }
      for (const std::int32_t p : points) on_way[p] = 0;
      if (!arrived) continue;
      for (const std::int32_t s : way) _state[s] = sharp_side;
    }
  }

  std::int32_t sharpest_ahead(std::int32_t at, std::int32_t last) const {
    const Vec3 way = normalized(point(at) - point(other_end(last, at)));
    std::int32_t best = -1;
    for (const std::int32_t s : sides_at(at)) {
      if (is_feature(s) || _turns[s] < weak_fraction * _angle) continue;
      if (dot(way, normalized(point(other_end(s, at)) - point(at))) < std::cos(straight)) continue;
      if (best < 0 || _turns[s] > _turns[best]) best = s;
    }
    return best;
  }

  /// The two triangles of a sharp side.
  std::array<std::int32_t, 2> triangles_of(std::int32_t s) const {
    const SideRecord& side = _table.sides[s];
    return {facet_of(_table.passes[side.begin].half_edge), facet_of(_table.passes[side.end - 1].half_edge)};
  }

  bool is_thin(std::int32_t t) const {
    const auto& [a, b, c] = _soup.triangles[t];
    const double longest =
        std::max({distance(point(a), point(b)), distance(point(b), point(c)), distance(point(c), point(a))});
    return norm(cross(point(b) - point(a), point(c) - point(a))) < lowest_face * longest * longest;
  }

  std::int32_t smoothest_side(std::int32_t t) const {
    const auto side = [&](int i) { return _table.side_of[3 * t + i]; };
    std::int32_t best = side(0);
    for (int i = 1; i < 3; ++i) {
      if (_turns[side(i)] < _turns[best]) best = side(i);
    }
    return best;
  }

  /// Whether a triangle is all of a face that is thin and joins the other one.
  bool is_scrap_of(geometry::DisjointSets<std::int32_t>& faces, const std::vector<std::int32_t>& size,
                   std::int32_t t, std::int32_t other) const {
    if (size[faces.root(t)] != 1 || !is_thin(t)) return false;
    const std::int32_t side = smoothest_side(t);
    if (_turns[side] >= island_turns * _angle && _turns[side] <= folded) return false;
    const auto [first, second] = triangles_of(side);
    return faces.root(first == t ? second : first) == other;
  }

  /// False where nothing was to be joined.
  bool join_small_faces() {
    const auto sides = static_cast<std::int32_t>(_table.sides.size());
    geometry::DisjointSets<std::int32_t> faces(_soup.triangles.size());
    for (std::int32_t s = 0; s < sides; ++s) {
      if (!is_feature(s)) faces.unite(triangles_of(s)[0], triangles_of(s)[1]);
    }
    constexpr std::int32_t several = -2;
    std::vector<std::int32_t> size(faces.size(), 0), neighbour(faces.size(), no_entity);
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(size.size()); ++t) ++size[faces.root(t)];
    for (std::int32_t s = 0; s < sides; ++s) {
      if (!is_feature(s)) continue;
      const auto [t, u] = triangles_of(s);
      const std::int32_t a = faces.root(t), b = faces.root(u);
      for (const auto& [own, other] : {std::pair(a, b), std::pair(b, a)}) {
        if (own == other && _state[s] == sharp_side) continue;
        const bool same = neighbour[own] == no_entity || neighbour[own] == other;
        neighbour[own] = same && _state[s] == sharp_side ? other : several;
      }
    }
    bool joined = false;
    for (std::int32_t s = 0; s < sides; ++s) {
      if (_state[s] != sharp_side) continue;
      const auto [t, u] = triangles_of(s);
      const std::int32_t a = faces.root(t), b = faces.root(u);
      const auto is_island = [&](std::int32_t f) {
        return size[f] <= island_triangles && neighbour[f] != several;
      };
      const bool island = a != b && (is_island(a) || is_island(b)) && _turns[s] < island_turns * _angle;
      const bool strips =
          size[a] <= strip_triangles && size[b] <= strip_triangles && _turns[s] < strip_turns * _angle;
      const bool scrap = is_scrap_of(faces, size, t, b) || is_scrap_of(faces, size, u, a);
      if (!island && !strips && !scrap) continue;
      _state[s] = smooth_side;
      joined = true;
    }
    return joined;
  }

  std::vector<std::int32_t> find_vertices() const {
    std::vector<std::int32_t> vertices;
    std::vector<char> is_vertex(_soup.points.size(), 0);
    for (const std::int32_t p : _touching) is_vertex[p] = 1;
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(is_vertex.size()); ++p) {
      const int count = degree(p);
      if (count > 0 && (count != 2 || turns_at(p))) is_vertex[p] = 1;
    }
    close_chains(is_vertex);
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(is_vertex.size()); ++p) {
      if (is_vertex[p] != 0) vertices.push_back(p);
    }
    return vertices;
  }

  bool turns_at(std::int32_t p) const {
    Vec3 ways[2];
    int count = 0;
    for (const std::int32_t s : sides_at(p)) {
      if (is_feature(s)) ways[count++] = normalized(point(other_end(s, p)) - point(p));
    }
    return dot(ways[0], -ways[1]) < std::cos(_angle);
  }

  /// Gives each closed chain without a vertex its lowest point as one.
  void close_chains(std::vector<char>& is_vertex) const {
    std::vector<char> reached(_soup.points.size(), 0);
    std::vector<std::int32_t> stack;
    const auto walk = [&](std::int32_t from) {
      stack.push_back(from);
      reached[from] = 1;
      while (!stack.empty()) {
        const std::int32_t p = stack.back();
        stack.pop_back();
        for (const std::int32_t s : sides_at(p)) {
          const std::int32_t q = other_end(s, p);
          if (!is_feature(s) || reached[q] != 0) continue;
          reached[q] = 1;
          stack.push_back(q);
        }
      }
    };
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(reached.size()); ++p) {
      if (is_vertex[p] != 0 && reached[p] == 0) walk(p);
    }
    for (std::int32_t p = 0; p < static_cast<std::int32_t>(reached.size()); ++p) {
      if (reached[p] != 0 || degree(p) == 0) continue;
      is_vertex[p] = 1;
      walk(p);
    }
  }

  const FacetSoup& _soup;
  const std::vector<FacetRegions>& _regions;
  const SideTable& _table;
  double _angle;
  std::vector<double> _turns;
  std::vector<char> _state;                        // of sides
  std::vector<std::int32_t> _first_at, _sides_at;  // sides at each point, ascending
  std::vector<std::int32_t> _touching;             // points where fans touch
};

}  // namespace

FacetFeatures find_features(const FacetSoup& soup, const std::vector<FacetRegions>& regions,
                            const SideTable& table, double angle) {
  return FeatureFinder(soup, regions, table, angle).find();
}

}  // namespace aeroloom::cad
