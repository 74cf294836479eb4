#include "layers/bends.hpp"

#include "layers/end_planes.hpp"
#include "layers/wanted_layers.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

// Bounds that say nothing else are chosen, not measured.

/// Of the height, from which columns bend; and how far, of the height that is left, they bend at most: the
/// tangent at their ends is twice as much. On the D150's wing, with rows sixteen times as long as high, 0.1 %
/// of the tetrahedra off the layers are below 12.0 degrees with straight columns, below 19.8 with these, 18.9
/// with 0.33 and 0.45, 15.1 with 0.5 and 0.6: the more columns lean, the more cells are bad, and cut short.
constexpr double straight_part = 0.2, most_off = 0.35;
/// What a slope of 1 of the heights takes off that.
constexpr double less_on_slopes = 0.4;
/// Lengths of the front's edges: at least so much of the longest edge of their triangle at the wall, and of
/// their own.
constexpr double least_edge = 0.45, kept_edge = 0.65;
/// Each moves columns by a quarter of what they lack: an edge is one of two triangles. As many as rows
/// squared.
constexpr int sweeps = 150;

class FrontSpreader {
public:
  FrontSpreader(const LocalWall& wall, const VertexStars& stars, const Fans& fans, const BendNeeds& needs)
      : _wall(wall), _stars(stars), _fans(fans), _needs(needs) {}

  std::vector<Bend> find() {
    measure_columns();
    limit_bends();
    list_springs();
    const std::int64_t springs = _wall.mesh.communicator.sum(static_cast<std::int64_t>(_springs.size()));
    if (springs == 0) return {};
    for (int sweep = 0; sweep < sweeps; ++sweep) spread();
    return std::move(_bends);
  }

private:
  /// Between the ends of two columns: `along` is the way from one to the other at the wall, a unit vector.
  struct Spring {
    std::array<std::int32_t, 2> columns;
    Vec3 along;
    double least;
  };

  /// The columns over sides, which triangles stand on, have slots: those of a corner come first, those of a
  /// ridge that passes first and last.
  int slot_of(std::int32_t column) const {
    const std::int32_t v = _fans.vertex_of(column), in_fan = column - _fans.first[v];
    const Ridge* ridge = _stars.ridge_at(v);
    if (_fans.count_at(v) == 1 || ridge == nullptr) return in_fan == 0 ? 0 : -1;
    if (ridge->is_corner()) return in_fan < static_cast<std::int32_t>(ridge->sides.size()) ? in_fan : -1;
    return in_fan == 0 ? 0 : in_fan + 1 == _fans.count_at(v) ? 1 : -1;
  }

  /// By vertex: 1 where a triangle is much longer than wide.
  std::vector<std::int32_t> find_stretched() const {
    std::vector<std::int32_t> found(_wall.points.size(), 0);
    for (std::int32_t t = 0; t < _wall.triangle_count(); ++t) {
      if (_wall.roles[t] != WallRole::layered) continue;
      if (!is_stretched(sides_of(_wall, t))) continue;
      for (const std::int32_t v : _wall.triangles[t]) found[v] = 1;
    }
    _wall.combine(found, [](std::int32_t a, std::int32_t b) { return std::max(a, b); });
    return found;
  }

  void measure_columns() {
    const auto columns = static_cast<std::size_t>(_fans.column_count());
    _bends.assign(columns, {}), _heights.assign(columns, 0), _slots.assign(columns, -1);
    const std::vector<std::int32_t> is_stretched = find_stretched();
    std::int64_t most = 1;
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
      const double height = _needs.heights[v];
      if (height == 0) continue;
      for (std::int32_t c = _fans.first[v]; c < _fans.first[v + 1]; ++c) {
        if (_needs.directions[c] == Vec3{}) continue;
        _heights[c] = height;
        _bends[c].from = straight_part * height, _bends[c].length = height - _bends[c].from;
        if (is_stretched[v] != 0 && _stars.ends.at(v) == nullptr) _slots[c] = slot_of(c);
        most = std::max<std::int64_t>(most, _slots[c] + 1);
      }
    }
    _sums.assign(static_cast<std::size_t>(_wall.mesh.communicator.maximum(most)),
                 std::vector<Vec3>(_wall.points.size()));
  }

  /// Columns bend less where heights differ along the wall: a front that slopes leans already.
  void limit_bends() {
    _most.assign(_bends.size(), 0);
    std::vector<double> slopes(_wall.points.size(), 0);
    for (std::int32_t v = 0; v < _wall.vertex_count(); ++v) {
      const double here = _heights[_fans.first[v]];
      if (here == 0) continue;
      _wall.for_each_neighbour(v, [&](std::int32_t u) {
        const double difference = std::abs(_heights[_fans.first[u]] - here);
        slopes[v] = std::max(
            slopes[v], difference / std::max(_needs.edges[v], distance(_wall.points[u], _wall.points[v])));
      });
    }
    _wall.combine(slopes, [](double a, double b) { return std::max(a, b); });
    for (std::size_t c = 0; c < _bends.size(); ++c) {
      const double slope = slopes[_fans.vertex_of(static_cast<std::int32_t>(c))];
      _most[c] = most_off * std::max(0.0, 1 - less_on_slopes * slope) * _bends[c].length;
    }
  }

  Vec3 end_of(std::int32_t c) const {
    return _wall.points[_fans.vertex_of(c)] + _heights[c] * _needs.directions[c] + _bends[c].off;
  }

  /// Those between edges of the wall, and around fans, that are too short or near it.
  void list_springs() {
    constexpr double near = 2;
    const auto add = [&](std::int32_t a, std::int32_t b, Vec3 way, double least) {
      if (_heights[a] == 0 || _heights[b] == 0 || (_slots[a] < 0 && _slots[b] < 0)) return;
      const Spring spring{{a, b}, normalized(way), least};
      if (length_of(spring) < near * least) _springs.push_back(spring);
    };
    for (std::int32_t t = 0; t < _wall.triangle_count(); ++t) {
      if (_wall.roles[t] != WallRole::layered) continue;
      std::array<Vec3, 3> sides;
      double longest = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        sides[i] = _wall.points[_wall.triangles[t][(i + 1) % 3]] - _wall.points[_wall.triangles[t][i]];
        longest = std::max(longest, norm(sides[i]));
      }
      for (std::size_t i = 0; i < 3; ++i)
        add(_fans.columns[t][i], _fans.columns[t][(i + 1) % 3], sides[i],
            std::max(least_edge * longest, kept_edge * norm(sides[i])));
    }
    for (const FanFace& face : _fans.faces) {
      const auto& [a, b, c, d] = face.columns;
      const double least =
          least_edge * std::min(_needs.edges[_fans.vertex_of(a)], _needs.edges[_fans.vertex_of(c)]);
      add(a, b, _needs.directions[b] - _needs.directions[a], least);
      if (d >= 0) add(d, c, _needs.directions[c] - _needs.directions[d], least);
    }
  }

  double length_of(const Spring& spring) const {
    return dot(end_of(spring.columns[1]) - end_of(spring.columns[0]), spring.along);
  }

  void spread() {
    constexpr double step = 0.25;
    for (std::vector<Vec3>& sums : _sums) std::fill(sums.begin(), sums.end(), Vec3{});
    for (const Spring& spring : _springs) {
      const double lack = spring.least - length_of(spring);
      if (lack <= 0) continue;
      const auto [a, b] = spring.columns;
      if (_slots[a] >= 0) _sums[_slots[a]][_fans.vertex_of(a)] += -step * lack * spring.along;
      if (_slots[b] >= 0) _sums[_slots[b]][_fans.vertex_of(b)] += step * lack * spring.along;
    }
    for (std::vector<Vec3>& sums : _sums) _wall.combine(sums, std::plus<>());
    for (std::size_t c = 0; c < _bends.size(); ++c) {
      const std::int32_t v = _fans.vertex_of(static_cast<std::int32_t>(c));
      if (_slots[c] < 0 || _sums[_slots[c]][v] == Vec3{}) continue;
      const Vec3 direction = _needs.directions[c];
      Vec3 off = _bends[c].off + _sums[_slots[c]][v];
      off = along_planes(off - dot(off, direction) * direction, _stars.planes_at(v));
      const double length = norm(off), most = _most[c];
      _bends[c].off = length > most ? most / length * off : off;
    }
  }

  const LocalWall& _wall;
  const VertexStars& _stars;
  const Fans& _fans;
  const BendNeeds& _needs;
  std::vector<Bend> _bends;             // by column, as the members that follow
  std::vector<double> _heights, _most;  // 0: no column; most they bend
  std::vector<int> _slots;              // -1: stays straight
  std::vector<Spring> _springs;
  std::vector<std::vector<Vec3>> _sums;  // by slot and vertex
};

}  // namespace

std::vector<Bend> find_bends(const LocalWall& wall, const VertexStars& stars, const Fans& fans,
                             const BendNeeds& needs) {
  return FrontSpreader(wall, stars, fans, needs).find();
}

}  // namespace aeroloom::layers
