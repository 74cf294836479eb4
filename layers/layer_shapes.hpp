/// The cells of one layer over a wall triangle or a face of a fan.
#pragma once

#include "mesh/data/shapes.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace aeroloom::layers {

/// A node of a column over a corner of a triangle or fan face. Level 0 is the wall vertex.
struct ColumnNode {
  int corner;
  std::int32_t level;
};

/// Numbers of layers of a triangle's columns, counter-clockwise seen from the fluid.
using LayersOverTriangle = std::array<std::int32_t, 3>;

/// Calls visit(shape, nodes) for the cell in layer k, if there is one.
template <class Visit>
void visit_layer(const LayersOverTriangle& counts, std::int32_t k, const Visit& visit) {
  using mesh::CellShape;
  const auto low = [&](int i) { return ColumnNode{i, std::min(k - 1, counts[i])}; };
  const auto high = [&](int i) { return ColumnNode{i, std::min(k, counts[i])}; };
  const auto live = [&](int i) { return counts[i] >= k; };
  switch (live(0) + live(1) + live(2)) {
    case 3:
      return visit(CellShape::prism, std::array{low(0), low(1), low(2), high(0), high(1), high(2)});
    case 2: {
      const int c = !live(2) ? 2 : !live(0) ? 0 : 1, a = (c + 1) % 3, b = (c + 2) % 3;
      return visit(CellShape::pyramid, std::array{low(a), high(a), high(b), low(b), high(c)});
    }
    case 1: {
      const int i = live(0) ? 0 : live(1) ? 1 : 2;
      return visit(CellShape::tetrahedron, std::array{low(i), low((i + 1) % 3), low((i + 2) % 3), high(i)});
    }
    default:
      return;
  }
}

/// Of a face of a fan (FanFace): whether it is a sector, and the numbers of layers at both its vertices. Of a
/// triangle both are that of its vertex.
struct LayersOverFan {
  bool is_sector;
  std::array<std::int32_t, 2> counts;
};

/// Calls visit(shape, nodes) for the cell in layer k, if there is one.
template <class Visit>
void visit_layer(const LayersOverFan& over, std::int32_t k, const Visit& visit) {
  using mesh::CellShape;
  const bool first = over.counts[0] >= k, second = over.counts[1] >= k;
  if (!first && !second) return;
  const auto low = [&](int i) { return ColumnNode{i, std::min(k - 1, over.counts[i / 2])}; };
  const auto high = [&](int i) { return ColumnNode{i, std::min(k, over.counts[i / 2])}; };
  if (!over.is_sector) {
    if (k == 1) return visit(CellShape::tetrahedron, std::array{low(0), high(0), high(1), high(2)});
    return visit(CellShape::prism, std::array{low(0), low(1), low(2), high(0), high(1), high(2)});
  }
  if (first && second) {
    if (k == 1)
      return visit(CellShape::prism, std::array{low(0), high(0), high(1), low(2), high(3), high(2)});
    return visit(CellShape::hexahedron,
                 std::array{low(0), low(1), low(2), low(3), high(0), high(1), high(2), high(3)});
  }
  // One goes on, with columns a and b; those of the other, c beside b and d beside a, have ended.
  const int a = first ? 0 : 2, b = a + 1, c = 2 - a, d = c + 1;
  if (over.counts[first ? 1 : 0] > 0)
    return visit(CellShape::prism, std::array{low(a), high(d), high(a), low(b), high(c), high(b)});
  if (k > 1) return visit(CellShape::pyramid, std::array{low(a), high(a), high(b), low(b), high(c)});
  visit(CellShape::tetrahedron, std::array{low(a), high(c), high(a), high(b)});
}

}  // namespace aeroloom::layers
