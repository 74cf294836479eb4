#include "cad/faceted/facet_sides.hpp"

#include "geometry/sort_by_number.hpp"

#include <algorithm>
#include <tuple>

namespace aeroloom::cad {

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

}  // namespace aeroloom::cad
