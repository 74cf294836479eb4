#include "sizing/features/ray_tree.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

using namespace aeroloom::sizing;
using aeroloom::geometry::Vec3;

namespace {

Vec3 point_at_random(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return {uniform(random), uniform(random), uniform(random)};
}

/// A pipe around an axis askew, of facets as long as the pipe.
void add_pipe(Vec3 from, double radius, std::vector<Triangle>& triangles) {
  const Vec3 axis = normalized(Vec3{1, 2, 1.5}), across = normalized(cross(axis, Vec3{1, 0, 0})),
             third = cross(axis, across);
  constexpr int facets = 24;
  const auto point = [&](int i, double along) {
    const double turn = 2 * std::numbers::pi * (i % facets) / facets;
    return from + along * axis + radius * (std::cos(turn) * across + std::sin(turn) * third);
  };
  for (int i = 0; i < facets; ++i) {
    triangles.push_back({point(i, 0), point(i + 1, 0), point(i, 10)});
    triangles.push_back({point(i + 1, 0), point(i + 1, 10), point(i, 10)});
  }
}

struct Search {
  const std::vector<Triangle>& triangles;
  RayTree tree{triangles};
  std::int64_t nodes = 0;

  template <class Counts>
  auto operator()(Vec3 point, Vec3 direction, double reach, const Counts& counts) {
    const auto corners = [&](std::int32_t t) -> const Triangle& { return triangles[t]; };
    return tree.nearest_crossings(point, direction, reach, corners, counts, nodes);
  }
};

/// Rays from within the pipes of a bundle, beside other triangles far away.
void expect_cheap_rays(std::vector<Triangle> triangles) {
  const Vec3 axis = normalized(Vec3{1, 2, 1.5}), across = normalized(cross(axis, Vec3{1, 0, 0})),
             third = cross(axis, across);
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) add_pipe(0.3 * i * across + 0.3 * j * third, 0.1, triangles);
  }
  Search search{triangles};
  // Through the edges between facets.
  const Vec3 direction = across;
  const int rays = 1000;
  for (int i = 0; i < rays; ++i) {
    const Vec3 middle = 0.3 * (i % 20) * across + 0.3 * (i / 20 % 20) * third + (1 + 0.008 * i) * axis;
    const auto found = search(middle, direction, 5, [](std::int32_t) { return true; });
    EXPECT_NEAR(found[0].distance, 0.1, 0.002);
    EXPECT_NEAR(found[1].distance, 0.1, 0.002);
  }
  EXPECT_LT(search.nodes, 400 * rays);
}

}  // namespace

/// What all triangles, one by one, tell.
TEST(RayTree, FindsWhatALineCrossesFirstAheadAndBehind) {
  std::vector<Triangle> triangles;
  std::mt19937_64 random(3);
  for (int i = 0; i < 40; ++i) add_pipe(3 * point_at_random(random), 0.2, triangles);
  Search search{triangles};
  int hits = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = 5 * point_at_random(random), direction = normalized(point_at_random(random));
    const auto counts = [&](std::int32_t t) { return (t + i) % 3 > 0; };
    const auto found = search(p, direction, 4, counts);
    std::array<RayTree::Crossing, 2> expected{RayTree::Crossing{-1, 4}, RayTree::Crossing{-1, 4}};
    const ShearedLine line(p, direction);
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(triangles.size()); ++t) {
      const double along = line.place_of(triangles[t]);
      RayTree::Crossing& side = expected[along > 0 ? 0 : 1];
      if (counts(t) && std::abs(along) < side.distance) side = {t, std::abs(along)};
    }
    for (int side = 0; side < 2; ++side) {
      EXPECT_EQ(found[side].triangle, expected[side].triangle);
      EXPECT_EQ(found[side].distance, expected[side].distance);
      hits += found[side].triangle >= 0;
    }
  }
  EXPECT_GT(hits, 200);
}

/// A ray from the wall of a pipe in a bundle meets the other side of it: what lies behind costs nothing,
/// however long the facets are.
TEST(RayTree, LooksNoFartherThanTheFirstWall) {
  expect_cheap_rays({});
}

/// Some long needles in all directions, as a plate with many holes has them, do not hide the direction of the
/// pipes.
TEST(RayTree, NeedlesDoNotHideWhatMostFacetsRunAlong) {
  std::mt19937_64 random(5);
  std::vector<Triangle> needles;
  for (int i = 0; i < 60; ++i) {
    const Vec3 from = 20 * point_at_random(random) + Vec3{60, 0, 0}, along = 20 * point_at_random(random);
    needles.push_back({from, from + along, from + 0.5 * along + 0.01 * point_at_random(random)});
  }
  expect_cheap_rays(needles);
}

/// Rays from within a closed surface, through its edges and corners: each meets a wall on both sides.
TEST(RayTree, NoLineSlipsThroughAnEdge) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Triangle> triangles;
  constexpr int around = 24, along = 12;
  const auto point = [&](int i, int j) {
    const double turn = 2 * std::numbers::pi * (i % around) / around, fall = std::numbers::pi * j / along;
    return Vec3{0.3, 0.1, -0.7} + 1.7 * Vec3{std::sin(fall) * std::cos(turn),
                                             j == 0 || j == along ? 0 : std::sin(fall) * std::sin(turn),
                                             std::cos(fall)};
  };
  const auto corner = [&](int i, int j) { return j == 0 || j == along ? point(0, j) : point(i, j); };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      if (j > 0) triangles.push_back({corner(i, j), corner(i, j + 1), corner(i + 1, j)});
      if (j + 1 < along) triangles.push_back({corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)});
    }
  }
  Search search{triangles};
  int missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 from = Vec3{0.3, 0.1, -0.7} + 0.5 * point_at_random(random);
    const Triangle& t = triangles[random() % triangles.size()];
    const double share = i % 4 == 0 ? 0 : uniform(random);
    const Vec3 to = (1 - share) * t[i % 3] + share * t[(i + 1) % 3];
    const auto found = search(from, normalized(to - from), 5, [](std::int32_t) { return true; });
    for (const RayTree::Crossing& crossing : found) missed += crossing.triangle < 0;
    EXPECT_NEAR(found[0].distance, distance(from, to), 1e-9);
  }
  EXPECT_EQ(missed, 0);
}
