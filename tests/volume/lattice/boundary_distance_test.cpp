#include "volume/lattice/boundary_distance.hpp"

#include "tests/meshes/surfaces.hpp"

#include <random>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;

std::vector<Vec3> random_points(int count, double extent) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-extent, extent);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {place(random), place(random), place(random)};
  return points;
}

double distance_to_cube(Vec3 p, double r) {
  const Vec3 beyond{std::abs(p.x) - r, std::abs(p.y) - r, std::abs(p.z) - r};
  const double most = std::max({beyond.x, beyond.y, beyond.z});
  const Vec3 out{std::max(beyond.x, 0.0), std::max(beyond.y, 0.0), std::max(beyond.z, 0.0)};
  return most > 0 ? norm(out) : -most;
}

TEST(BoundaryDistance, is_the_distance_to_a_cube) {
  const surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 7);
  const BoundaryDistance boundary(surface.points, surface.triangles);
  std::int32_t guess = -1;
  for (const Vec3& p : random_points(2000, 2)) {
    const auto nearest = boundary.nearest(p, guess);
    EXPECT_NEAR(nearest.distance, distance_to_cube(p, 1), 1e-14);
    EXPECT_NEAR(boundary.distance_to(p, nearest.triangle), nearest.distance, 1e-14);
    EXPECT_NEAR(distance_to_cube(boundary.foot_point(p, nearest.triangle), 1), 0, 1e-15);
    guess = nearest.triangle;
  }
}

TEST(BoundaryDistance, is_the_least_distance_to_any_triangle) {
  const surfaces::Surface surface = surfaces::cube_with_ball(3, 5);
  const BoundaryDistance boundary(surface.points, surface.triangles);
  for (const Vec3& p : random_points(300, 3)) {
    double least = 1e300;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      least = std::min(least, boundary.distance_to(p, static_cast<std::int32_t>(t)));
    EXPECT_EQ(boundary.nearest(p).distance, least);
    EXPECT_EQ(boundary.nearest(p, 11).distance, least);
  }
}

TEST(BoundaryDistance, tells_whether_the_foot_point_is_inside_of_its_triangle) {
  const surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 1);
  const BoundaryDistance boundary(surface.points, surface.triangles);
  EXPECT_TRUE(boundary.nearest({1.5, 0.3, 0.1}).in_face);
  EXPECT_TRUE(boundary.nearest({0.9, 0.3, 0.1}).in_face);
  EXPECT_FALSE(boundary.nearest({1.5, 1.5, 0.1}).in_face);  // an edge
  EXPECT_FALSE(boundary.nearest({1.5, 1.5, 1.5}).in_face);  // a corner
  EXPECT_FALSE(boundary.nearest({1.5, 0, 0}).in_face);      // the diagonal of a side
}

TEST(BoundaryDistance, knows_its_mean_edges_and_box) {
  surfaces::Surface surface = surfaces::box({0, 0, 0}, {3, 4, 5}, {1, 1, 1});
  const BoundaryDistance boundary(surface.points, surface.triangles);
  EXPECT_EQ(boundary.box().low, (Vec3{0, 0, 0}));
  EXPECT_EQ(boundary.box().high, (Vec3{3, 4, 5}));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& v = surface.triangles[t];
    const Vec3 a = surface.points[v[0]], b = surface.points[v[1]], c = surface.points[v[2]];
    EXPECT_NEAR(boundary.mean_edge(static_cast<std::int32_t>(t)),
                (distance(a, b) + distance(b, c) + distance(c, a)) / 3, 1e-14);
  }
}

TEST(BoundaryDistance, lists_all_pairs_whose_boxes_overlap_once) {
  const surfaces::Surface surface = surfaces::cube_with_ball(3, 3);
  const BoundaryDistance boundary(surface.points, surface.triangles);
  const auto box = [&](std::size_t t) {
    geometry::Box result;
    for (const auto v : surface.triangles[t]) result.add(surface.points[v]);
    return result;
  };
  std::set<std::pair<std::int32_t, std::int32_t>> visited;
  boundary.for_each_overlapping_pair([&](std::int32_t a, std::int32_t b) {
    EXPECT_LT(a, b);
    EXPECT_TRUE(visited.insert({a, b}).second);
  });
  for (std::size_t a = 0; a < surface.triangles.size(); ++a) {
    for (std::size_t b = a + 1; b < surface.triangles.size(); ++b) {
      if (box(a).overlaps(box(b))) {
        EXPECT_TRUE(visited.count({static_cast<std::int32_t>(a), static_cast<std::int32_t>(b)}));
      }
    }
  }
}

}  // namespace
}  // namespace aeroloom::volume
