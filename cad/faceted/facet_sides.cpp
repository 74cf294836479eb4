#include "cad/faceted/facet_sides.hpp"

#include "geometry/angle.hpp"
#include "geometry/sort_by_number.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

namespace aeroloom::cad {
namespace {

using geometry::Vec3;

/// Files write coordinates with about six digits. A triangle that is lower than so many units of the last one
/// has no normal of its own: it would be off by degrees. Chosen.
constexpr double last_digit = 5e-7, lowest_in_digits = 20;
/// A small triangle lies in the plane of a neighbour if its own normal is so near: rounding does not make it
/// so. It is small, and no needle, if it is higher than this fraction of its longest side. Chosen.
constexpr double one_plane = 1 * geometry::degree, lowest_of_small = 0.05;

class FacetNormals {
public:
  FacetNormals(const FacetSoup& soup, const SideTable& table) : _soup(soup), _table(table) {}

  std::vector<Vec3> find() {
    double largest = 0;
    for (const Vec3 p : _soup.points)
      largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    const double lowest = lowest_in_digits * last_digit * largest;
    _normals.resize(_soup.triangles.size());
    _known.assign(_soup.triangles.size(), 0);
    std::vector<std::int32_t> thin, small;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(_normals.size()); ++t) {
      const auto& [a, b, c] = _soup.triangles[t];
      const Vec3 area = cross(point(b) - point(a), point(c) - point(a));
      const double longest = std::max(
          {distance(point(a), point(b)), distance(point(b), point(c)), distance(point(c), point(a))});
      _normals[t] = normalized(area);
      if (norm(area) >= lowest * longest) {
        _known[t] = 1;
      } else {
        (norm(area) >= lowest_of_small * longest * longest ? small : thin).push_back(t);
      }
    }
    // Small ones first from those in whose plane they lie: where a plane runs to a point, as at the end of a
    // sharp trailing edge, their longest sides are those of its border.
    while (inherit(small, 3, one_plane)) continue;
    thin.insert(thin.end(), small.begin(), small.end());
    std::sort(thin.begin(), thin.end());
    // Then over the longest side alone, then over any.
    for (int sides = 1; sides <= 3; ++sides) {
      while (inherit(thin, sides, std::numbers::pi)) continue;
    }
    return std::move(_normals);
  }

private:
  Vec3 point(std::int32_t p) const { return _soup.points[p]; }

  /// One round: what is known at its begin counts, so that order does not. Neighbours count whose normal is
  /// no farther than `turn` from that of the triangle itself. False when nothing came of it.
  bool inherit(std::vector<std::int32_t>& thin, int sides, double turn) {
    std::vector<std::int32_t> found, from;
    for (const std::int32_t t : thin) {
      const std::array<std::int32_t, 3> order = sides_by_length(t);
      for (int i = 0; i < sides; ++i) {
        const std::int32_t other = neighbour(3 * t + order[i]);
        if (other < 0 || _known[other] == 0) continue;
        if (turn < std::numbers::pi && !(angle_between(_normals[t], _normals[other]) <= turn)) continue;
        found.push_back(t), from.push_back(other);
        break;
      }
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
      _normals[found[i]] = _normals[from[i]];
      _known[found[i]] = 1;
    }
    std::erase_if(thin, [&](std::int32_t t) { return _known[t] != 0; });
    return !found.empty() && !thin.empty();
  }

  std::array<std::int32_t, 3> sides_by_length(std::int32_t t) const {
    const auto length = [&](std::int32_t i) {
      return distance(point(side_begin(_soup.triangles, 3 * t + i)),
                      point(side_end(_soup.triangles, 3 * t + i)));
    };
    std::array<std::int32_t, 3> order = {0, 1, 2};
    std::ranges::stable_sort(order, [&](std::int32_t i, std::int32_t j) { return length(i) > length(j); });
    return order;
  }

  /// Over a side of two triangles; -1 over others.
  std::int32_t neighbour(geometry::HalfEdge h) const {
    const SideRecord& side = _table.sides[_table.side_of[h]];
    if (side.passes() != 2) return -1;
    const std::int32_t first = facet_of(_table.passes[side.begin].half_edge);
    return first == facet_of(h) ? facet_of(_table.passes[side.begin + 1].half_edge) : first;
  }

  const FacetSoup& _soup;
  const SideTable& _table;
  std::vector<Vec3> _normals;
  std::vector<char> _known;
};

}  // namespace

std::vector<FacetSide> sort_sides(const std::vector<geometry::TriangleCorners>& triangles) {
  std::vector<FacetSide> sides;
  sides.reserve(3 * triangles.size());
  for (geometry::HalfEdge h = 0; h < static_cast<geometry::HalfEdge>(3 * triangles.size()); ++h) {
    const std::int32_t a = side_begin(triangles, h), b = side_end(triangles, h);
    sides.push_back({std::min(a, b), std::max(a, b), h});
  }
  geometry::sort_by_number(
      sides, [](const FacetSide& s) { return s.low; },
      [](const FacetSide& a, const FacetSide& b) {
        return std::tie(a.high, a.half_edge) < std::tie(b.high, b.half_edge);
      });
  return sides;
}

std::vector<geometry::HalfEdge> open_sides(const std::vector<geometry::TriangleCorners>& triangles) {
  std::vector<geometry::HalfEdge> open;
  for_each_side(sort_sides(triangles), [&](std::span<const FacetSide> passes) {
    if (passes.size() == 1) open.push_back(passes.front().half_edge);
  });
  std::sort(open.begin(), open.end());
  return open;
}

UnevenSides count_uneven_sides(const std::vector<geometry::TriangleCorners>& triangles) {
  UnevenSides counts;
  for_each_side(sort_sides(triangles), [&](std::span<const FacetSide> passes) {
    counts.open += passes.size() == 1;
    counts.many += passes.size() > 2;
  });
  return counts;
}

SideTable make_side_table(const std::vector<geometry::TriangleCorners>& triangles) {
  SideTable table;
  table.passes = sort_sides(triangles);
  table.side_of.resize(table.passes.size());
  std::int32_t begin = 0;
  for_each_side(table.passes, [&](std::span<const FacetSide> passes) {
    const auto end = begin + static_cast<std::int32_t>(passes.size());
    for (const FacetSide& pass : passes)
      table.side_of[pass.half_edge] = static_cast<std::int32_t>(table.sides.size());
    table.sides.push_back({passes.front().low, passes.front().high, begin, end});
    begin = end;
  });
  return table;
}

std::vector<double> measure_turns(const FacetSoup& soup, const SideTable& table) {
  const std::vector<Vec3> normals = FacetNormals(soup, table).find();
  std::vector<double> turns(table.sides.size(), std::numbers::pi);
  for (std::size_t s = 0; s < turns.size(); ++s) {
    const SideRecord& side = table.sides[s];
    if (side.passes() != 2) continue;
    const Vec3 a = normals[facet_of(table.passes[side.begin].half_edge)];
    const Vec3 b = normals[facet_of(table.passes[side.begin + 1].half_edge)];
    turns[s] = angle_between(a, b);
  }
  return turns;
}

}  // namespace aeroloom::cad
