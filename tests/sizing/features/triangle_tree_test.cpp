#include "sizing/features/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

using namespace aeroloom::sizing;
using aeroloom::geometry::Vec3;

namespace {

/// The unit sphere by latitude and longitude, outward.
std::vector<Triangle> sphere(int n) {
  const auto point = [&](int i, int j) {
    const double a = std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / (2 * n);
    return Vec3{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)};
  };
  std::vector<Triangle> triangles;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < 2 * n; ++j) {
      if (i > 0) triangles.push_back({point(i, j), point(i + 1, j), point(i, j + 1)});
      if (i + 1 < n) triangles.push_back({point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
    }
  }
  return triangles;
}

Vec3 random_point(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1.5, 1.5);
  return {uniform(random), uniform(random), uniform(random)};
}

}  // namespace

TEST(TriangleTree, TellsInsideFromOutside) {
  const auto triangles = sphere(30);
  const TriangleTree tree(triangles);
  std::vector<std::int32_t> all(triangles.size());
  std::iota(all.begin(), all.end(), 0);
  std::mt19937_64 random(1);
  for (int i = 0; i < 500; ++i) {
    const Vec3 p = random_point(random);
    if (std::abs(norm(p) - 1) < 0.01) continue;
    EXPECT_EQ(tree.contains(p), norm(p) < 1);
    EXPECT_EQ(tree.fraction_behind(p, 1e-6, all), norm(p) < 1 ? 1 : 0);
  }
}

TEST(TriangleTree, SharesOfCubesAddUpToTheVolume) {
  const TriangleTree tree(sphere(60));
  std::vector<std::int32_t> touching;
  for (const int cubes : {10, 17, 30}) {
    const double edge = 2.4 / cubes;
    double volume = 0;
    for (int i = 0; i < cubes * cubes * cubes; ++i) {
      const int column = i % cubes, row = i / cubes % cubes, layer = i / (cubes * cubes);
      const Vec3 low = edge * Vec3{double(column), double(row), double(layer)} - Vec3{1.2, 1.2, 1.2};
      tree.find_overlapping(low, edge, touching);
      const bool inside = norm(low + 0.5 * edge * Vec3{1, 1, 1}) < 1;
      volume += edge * edge * edge * (touching.empty() ? inside : tree.fraction_behind(low, edge, touching));
    }
    EXPECT_NEAR(volume, 4 * std::numbers::pi / 3, 2.5 * edge * edge) << edge;
  }
}

TEST(TriangleTree, FindsWhatOverlapsACube) {
  const TriangleTree tree(sphere(30));
  std::mt19937_64 random(2);
  std::vector<std::int32_t> found;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 low = random_point(random);
    const double edge = 0.2;
    tree.find_overlapping(low, edge, found);
    double nearest = 1e300, farthest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const double r =
          norm(low + edge * Vec3{double(corner & 1), double(corner >> 1 & 1), double(corner >> 2)});
      nearest = std::min(nearest, r), farthest = std::max(farthest, r);
    }
    if (nearest < 0.99 && farthest > 1.01) {
      EXPECT_FALSE(found.empty());
    }
    if (farthest < 0.98 || nearest > 1.3) {
      EXPECT_TRUE(found.empty());
    }
  }
}

TEST(TriangleTree, EmptyContainsNothing) {
  const TriangleTree tree({});
  std::vector<std::int32_t> found;
  tree.find_overlapping({0, 0, 0}, 1, found);
  EXPECT_TRUE(found.empty());
  EXPECT_FALSE(tree.contains({0, 0, 0}));
}

/// Facets of a cube within another are found among those of the other, few or many.
TEST(TriangleTree, KeepsWhatASmallerCubeMeets) {
  const TriangleTree tree(sphere(60));
  std::mt19937_64 random(3);
  std::vector<std::int32_t> outer, found, kept;
  int few = 0, many = 0;
  for (int i = 0; i < 2000; ++i) {
    const double edge = i % 2 == 0 ? 0.1 : 1;
    const Vec3 low = random_point(random);
    tree.find_overlapping(low, edge, outer);
    const Vec3 inner = low + 0.5 * edge * Vec3{double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)};
    tree.find_overlapping(inner, 0.5 * edge, found);
    tree.keep_overlapping(inner, 0.5 * edge, outer, kept);
    EXPECT_EQ(kept, found);
    few += !outer.empty() && outer.size() < 30;
    many += outer.size() > 100;
  }
  EXPECT_GT(few, 20);
  EXPECT_GT(many, 20);
}

/// A bundle of needles that runs along no axis: few of them are near any place.
TEST(TriangleTree, FindsSlenderTrianglesWhereTheyAre) {
  const Vec3 along = aeroloom::geometry::normalized(Vec3{1, 2, -1.5});
  const Vec3 side = aeroloom::geometry::normalized(cross(along, Vec3{0, 0, 1})), up = cross(along, side);
  constexpr double length = 100, radius = 0.3;
  constexpr int across = 20;
  std::vector<Triangle> triangles;
  const auto add_prism = [&](Vec3 foot) {
    std::array<Vec3, 3> low, high;
    for (int i = 0; i < 3; ++i) {
      const double turn = 2 * std::numbers::pi * i / 3;
      low[i] = foot + radius * std::cos(turn) * side + radius * std::sin(turn) * up;
      high[i] = low[i] + length * along;
    }
    for (int i = 0; i < 3; ++i) {
      const int next = (i + 1) % 3;
      triangles.push_back({low[i], low[next], high[i]});
      triangles.push_back({low[next], high[next], high[i]});
    }
    triangles.push_back({low[0], low[2], low[1]});
    triangles.push_back({high[0], high[1], high[2]});
  };
  for (int i = 0; i < across * across; ++i) add_prism(double(i % across) * side + double(i / across) * up);
  const TriangleTree tree(triangles);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<std::int32_t> found;
  std::size_t most = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 foot = double(random() % across) * side + double(random() % across) * up;
    const Vec3 inside = foot + (1 + 98 * uniform(random)) * along;
    EXPECT_TRUE(tree.contains(inside));
    EXPECT_FALSE(tree.contains(inside + 0.5 * side + 0.5 * up));
    tree.find_overlapping(inside - Vec3{0.5, 0.5, 0.5}, 1, found);
    EXPECT_FALSE(found.empty());
    most = std::max(most, found.size());
  }
  EXPECT_LT(most, 150);
}
