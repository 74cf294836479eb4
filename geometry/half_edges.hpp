/// Half-edges of a constant triangulation; triangle_links.hpp is for triangulations that change.
///
/// Half-edge 3 t + i runs from corner i of triangle t to its next corner. Corner 3 t + i is the start of that
/// half-edge.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::geometry {

using HalfEdge = std::int32_t;
using TriangleCorners = std::array<std::int32_t, 3>;

constexpr HalfEdge next_half_edge(HalfEdge h) {
  return h % 3 == 2 ? h - 2 : h + 1;
}
constexpr HalfEdge previous_half_edge(HalfEdge h) {
  return h % 3 == 0 ? h + 2 : h - 1;
}

/// The opposite half-edge of each half-edge, in the neighbouring triangle; -1 on the boundary. If more than
/// two triangles share an edge, they are paired in their order.
std::vector<HalfEdge> match_half_edges(const std::vector<TriangleCorners>& triangles);

}  // namespace aeroloom::geometry
