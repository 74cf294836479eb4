#include "layers/vertex_fans.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <numeric>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

/// Along the arc from a unit vector to another.
Vec3 between(Vec3 a, Vec3 b, double at) {
  const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0));
  if (angle < 1e-9) return a;
  return normalized(std::sin((1 - at) * angle) * a + std::sin(at * angle) * b);
}

/// Fills a closed line of directions with rings of fewer and fewer, and one in the middle.
class RingFill {
public:
  RingFill(VertexFan& fan, std::vector<std::int32_t> ring) : _fan(fan), _outer(std::move(ring)) {}

  void fill() {
    Vec3 sum;
    for (const std::int32_t c : _outer) sum += _fan.directions[c];
    const Vec3 middle = normalized(sum);
    const std::size_t n = _outer.size();
    double radius = 0, perimeter = 0;
    for (std::size_t i = 0; i < n; ++i) {
      radius += std::acos(std::clamp(dot(at(i), middle), -1.0, 1.0)) / static_cast<double>(n);
      perimeter += norm(at(i) - at(i + 1));
    }
    const auto rings =
        static_cast<std::int32_t>(std::max(1.0, std::round(radius * static_cast<double>(n) / perimeter)));
    std::vector<std::int32_t> last = _outer;
    for (std::int32_t r = 1; r < rings; ++r) {
      const double inwards = static_cast<double>(r) / rings;
      const auto count = std::max<std::size_t>(3, static_cast<std::size_t>(std::lround((1 - inwards) * n)));
      std::vector<std::int32_t> ring;
      for (std::size_t k = 0; k < count; ++k) {
        const double u = static_cast<double>(k) * n / count;
        const auto whole = static_cast<std::size_t>(u);
        add(between(between(at(whole), at(whole + 1), u - whole), middle, inwards), ring);
      }
      close(last, ring);
      last = std::move(ring);
    }
    std::vector<std::int32_t> centre;
    add(middle, centre);
    for (std::size_t i = 0; i < last.size(); ++i)
      _fan.triangles.push_back({last[i], last[(i + 1) % last.size()], centre[0]});
  }

private:
  Vec3 at(std::size_t i) const { return _fan.directions[_outer[i % _outer.size()]]; }

  void add(Vec3 direction, std::vector<std::int32_t>& ring) {
    ring.push_back(static_cast<std::int32_t>(_fan.directions.size()));
    _fan.directions.push_back(direction);
  }

  /// Triangles between two rings; both start at the same place.
  void close(const std::vector<std::int32_t>& outer, const std::vector<std::int32_t>& inner) {
    const std::size_t a = outer.size(), b = inner.size();
    for (std::size_t i = 0, j = 0; i < a || j < b;) {
      const bool goes_on_outside = j == b || (i < a && (2 * i + 1) * b <= (2 * j + 1) * a);
      if (goes_on_outside) {
        _fan.triangles.push_back({outer[i % a], outer[(i + 1) % a], inner[j % b]});
        ++i;
      } else {
        _fan.triangles.push_back({outer[i % a], inner[(j + 1) % b], inner[j % b]});
        ++j;
      }
    }
  }

  VertexFan& _fan;
  std::vector<std::int32_t> _outer;
};

/// The angles between rays of these lengths whose ends, with the centre, span triangles of equal areas.
template <class Radius>
std::vector<double> equal_triangles(const Radius& radius, std::int32_t sectors, double turn) {
  std::vector<double> products(sectors), angles(sectors);
  for (std::int32_t i = 0; i < sectors; ++i) products[i] = radius(i) * radius(i + 1);
  double low = 0, high = *std::min_element(products.begin(), products.end());
  for (int halving = 0; halving < 60; ++halving) {
    const double doubled_area = 0.5 * (low + high);
    double sum = 0;
    for (std::int32_t i = 0; i < sectors; ++i) sum += angles[i] = std::asin(doubled_area / products[i]);
    (sum < turn ? low : high) = doubled_area;
  }
  // Where no sector may be as wide as a right angle the areas stay unequal.
  const double sum = std::accumulate(angles.begin(), angles.end(), 0.0);
  for (double& angle : angles) angle *= turn / sum;
  return angles;
}

/// Parts an edge's turn into sectors, from the column of the left side to that of the right, both included.
/// Seen along the edge the triangles between them have equal areas: over a long flat cell the centres of
/// neighbours would else lie apart along the edge by more than the cells are wide.
std::optional<std::vector<Vec3>> part_turn(const Ridge::Turn& turn, Vec3 left, Vec3 right,
                                           std::int32_t sectors) {
  // An angle in radians; chosen, not measured.
  constexpr double most_off = 1.2, least_radius = 0.5, largest_radius = 2;
  const Vec3 along = cross(turn.normal, turn.across);
  struct Polar {
    double angle, radius, ahead;
  };
  const auto polar = [&](Vec3 column, double near) {
    const double x = dot(column, turn.normal), y = dot(column, turn.across);
    double angle = std::atan2(y, x);
    while (angle < near - std::numbers::pi) angle += 2 * std::numbers::pi;
    return Polar{angle, std::hypot(x, y), dot(column, along)};
  };
  const Polar first = polar(left, 0), last = polar(right, turn.angle);
  if (std::abs(first.angle) > most_off || std::abs(last.angle - turn.angle) > most_off ||
      std::min(first.radius, last.radius) < least_radius ||
      std::max(first.radius, last.radius) > largest_radius)
    return std::nullopt;
  const auto radius = [&](std::int32_t i) {
    return first.radius + (last.radius - first.radius) * i / sectors;
  };
  const std::vector<double> angles = equal_triangles(radius, sectors, last.angle - first.angle);
  std::vector<Vec3> directions{left};
  double angle = first.angle;
  for (std::int32_t i = 1; i < sectors; ++i) {
    angle += angles[i - 1];
    directions.push_back(radius(i) * turn.direction(angle) +
                         (first.ahead + (last.ahead - first.ahead) * i / sectors) * along);
  }
  directions.push_back(right);
  return directions;
}

/// The column over a side, which seen along its edges is as high as it.
Vec3 column_over(Vec3 side, std::initializer_list<Vec3> normals) {
  constexpr double least_seen = 0.3;  // chosen, not measured
  double seen = 0;
  for (const Vec3 normal : normals) seen += dot(side, normal) / static_cast<double>(normals.size());
  return side / std::max(seen, least_seen);
}

bool is_good(const VertexFan& fan) {
  constexpr double least_volume = 1e-4;  // chosen, not measured
  return std::all_of(fan.triangles.begin(), fan.triangles.end(), [&](const auto& t) {
    return dot(fan.directions[t[0]], cross(fan.directions[t[1]], fan.directions[t[2]])) > least_volume;
  });
}

std::optional<VertexFan> fill_corner(const Ridge& ridge, std::span<const std::int32_t> sectors) {
  VertexFan fan;
  for (std::size_t side = 0; side < ridge.sides.size(); ++side) {
    const Ridge::Turn& before = ridge.turns[(side + 1) % ridge.edges.size()];
    fan.directions.push_back(
        column_over(ridge.sides[side], {ridge.turns[side].direction(0), before.direction(before.angle)}));
    fan.of_side.push_back(static_cast<std::int32_t>(side));
  }
  for (std::size_t e = 0; e < ridge.edges.size(); ++e) {
    const std::size_t right = ridge.right_of(e);
    const auto directions = part_turn(ridge.turns[e], fan.directions[e], fan.directions[right], sectors[e]);
    if (!directions) return std::nullopt;
    std::vector<std::int32_t>& across = fan.across.emplace_back(1, fan.of_side[e]);
    for (std::int32_t i = 1; i < sectors[e]; ++i) {
      across.push_back(static_cast<std::int32_t>(fan.directions.size()));
      fan.directions.push_back((*directions)[i]);
    }
    across.push_back(fan.of_side[right]);
  }
  std::vector<std::int32_t> ring;
  for (std::size_t side = 0; side < ridge.sides.size(); ++side) {
    const std::vector<std::int32_t>& across = fan.across[(side + 1) % ridge.edges.size()];
    ring.insert(ring.end(), across.rbegin(), across.rend() - 1);
  }
  RingFill(fan, std::move(ring)).fill();
  return fan;
}

}  // namespace

std::optional<VertexFan> make_vertex_fan(const Ridge& ridge, std::span<const std::int32_t> sectors) {
  if (ridge.is_corner()) {
    std::optional<VertexFan> fan = fill_corner(ridge, sectors);
    if (!fan || !is_good(*fan)) return std::nullopt;
    fan->visibility = ridge.cone;
    return fan;
  }
  const bool passes = ridge.edges.size() > 1;
  if (passes && sectors[0] != sectors[1]) return std::nullopt;
  const std::int32_t most = sectors[0];
  const Ridge::Turn& turn = ridge.turns[0];
  VertexFan fan;
  std::vector<std::int32_t> all;
  for (std::int32_t i = 0; i <= most; ++i) {
    all.push_back(i);
    const Vec3 column = turn.direction(i * turn.angle / most), edge = ridge.edges[0].direction;
    const bool has_mitre = passes || !(ridge.mitre == Vec3{});
    fan.directions.push_back(has_mitre ? column + dot(column, ridge.mitre) * ridge.mitre
                                       : column - dot(column, ridge.plane) / dot(edge, ridge.plane) * edge);
  }
  fan.across.push_back(all);
  if (passes) fan.across.emplace_back(all.rbegin(), all.rend());
  fan.visibility = ridge.cone;
  fan.of_side = {0, most};
  return fan;
}

}  // namespace aeroloom::layers
