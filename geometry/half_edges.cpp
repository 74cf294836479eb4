#include "geometry/half_edges.hpp"

#include "geometry/runs.hpp"
#include "geometry/sort_by_number.hpp"

#include <algorithm>
#include <tuple>

namespace aeroloom::geometry {

std::vector<HalfEdge> match_half_edges(const std::vector<TriangleCorners>& triangles) {
  struct SortedEdge {
    std::int32_t low, high;
    bool backward;
    HalfEdge half_edge;
  };
  std::vector<SortedEdge> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::int32_t a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), a > b, static_cast<HalfEdge>(3 * t + i)});
    }
  }
  sort_by_number(
      sides, [](const SortedEdge& side) { return side.low; },
      [](const SortedEdge& a, const SortedEdge& b) {
        return std::tie(a.high, a.backward, a.half_edge) < std::tie(b.high, b.backward, b.half_edge);
      });
  std::vector<HalfEdge> twins(3 * triangles.size(), -1);
  const auto same = [](const SortedEdge& a, const SortedEdge& b) {
    return a.low == b.low && a.high == b.high;
  };
  for_each_run(std::span<const SortedEdge>(sides), same, [&](std::size_t begin, std::size_t end) {
    std::size_t middle = begin;
    while (middle < end && !sides[middle].backward) ++middle;
    for (std::size_t i = begin, j = middle; i < middle && j < end; ++i, ++j) {
      twins[sides[i].half_edge] = sides[j].half_edge;
      twins[sides[j].half_edge] = sides[i].half_edge;
    }
  });
  return twins;
}

}  // namespace aeroloom::geometry
