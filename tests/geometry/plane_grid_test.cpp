#include "geometry/plane_grid.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

struct Map {
  std::vector<Vec2> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
};

/// A square of n x n cells, two triangles each, the diagonals alike.
Map square(int n) {
  Map map;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) map.points.push_back({static_cast<double>(i), static_cast<double>(j)});
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      map.triangles.push_back({a, b, d});
      map.triangles.push_back({a, d, c});
    }
  }
  return map;
}

TEST(PlaneGrid, TheCellOfAPointListsTheTriangleThatHoldsIt) {
  const Map map = square(12);
  const PlaneGrid grid(map.points, map.triangles);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 12);
  for (int k = 0; k < 500; ++k) {
    const Vec2 p{place(random), place(random)};
    const int i = static_cast<int>(p.x), j = static_cast<int>(p.y);
    const std::int32_t holder = 2 * (12 * j + i) + (p.y - j > p.x - i ? 1 : 0);
    const auto [column, row] = grid.cell_of(p);
    const auto listed = grid.triangles_in(column, row);
    EXPECT_NE(std::find(listed.begin(), listed.end(), holder), listed.end());
    EXPECT_LT(listed.size(), 40u) << "cells are about as fine as triangles";
  }
}

TEST(PlaneGrid, PointsOutsideFallIntoTheNearestCell) {
  const Map map = square(4);
  const PlaneGrid grid(map.points, map.triangles);
  EXPECT_EQ(grid.cell_of({-5, -5}), (std::array<std::int32_t, 2>{0, 0}));
  EXPECT_EQ(grid.cell_of({50, 50}), (std::array<std::int32_t, 2>{grid.columns() - 1, grid.rows() - 1}));
}

TEST(PlaneGrid, FoldedTrianglesAreLeftOut) {
  Map map = square(1);
  std::swap(map.triangles[1][1], map.triangles[1][2]);
  const PlaneGrid grid(map.points, map.triangles);
  for (std::int32_t column = 0; column < grid.columns(); ++column) {
    for (std::int32_t row = 0; row < grid.rows(); ++row) {
      for (const std::int32_t t : grid.triangles_in(column, row)) EXPECT_EQ(t, 0);
    }
  }
}

}  // namespace
}  // namespace aeroloom::geometry
