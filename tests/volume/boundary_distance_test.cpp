#include "volume/boundary_distance.hpp"

#include "tests/volume/surfaces.hpp"

#include <random>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;

std::vector<Vec3> random_points(int count, double reach) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-reach, reach);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = {place(random), place(random), place(random)};
  return points;
}

TEST(BoundaryDistance, is_the_distance_to_a_cube) {
  const ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 7);
  const BoundaryDistance boundary(surface.points, surface.triangles);
  std::int32_t guess = -1;
  for (const Vec3& p : random_points(2000, 2)) {
    const Vec3 beyond{std::abs(p.x) - 1, std::abs(p.y) - 1, std::abs(p.z) - 1};
    const double most = std::max({beyond.x, beyond.y, beyond.z});
    const Vec3 out{std::max(beyond.x, 0.0), std::max(beyond.y, 0.0), std::max(beyond.z, 0.0)};
    const auto nearest = boundary.nearest(p, guess);
    EXPECT_NEAR(nearest.distance, most > 0 ? norm(out) : -most, 1e-14);
    EXPECT_EQ(boundary.inside(p, nearest), most < 0);
    guess = nearest.triangle;
  }
}

TEST(BoundaryDistance, tells_the_side_in_nested_voids) {
  ClosedSurface surface = surfaces::cube({0, 0, 0}, 2, 5);
  surfaces::append(surface, surfaces::sphere({0, 0, 0}, 1, 6), surfaces::Turn::inward);
  surfaces::append(surface, surfaces::sphere({0, 0, 0}, 0.5, 5));
  surfaces::append(surface, surfaces::cube({0, 0, 0}, 0.2, 2), surfaces::Turn::inward);
  const BoundaryDistance boundary(surface.points, surface.triangles);
  for (const Vec3& p : random_points(4000, 2.5)) {
    const double r = norm(p), cube = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    if (std::abs(r - 1) < 0.03 || std::abs(r - 0.5) < 0.03) continue;  // spheres have facets
    const bool expected = cube < 2 && (r > 1 || (r < 0.5 && cube > 0.2));
    EXPECT_EQ(boundary.inside(p), expected) << p.x << ' ' << p.y << ' ' << p.z;
    EXPECT_EQ(boundary.inside(p, boundary.nearest(p)), expected) << p.x << ' ' << p.y << ' ' << p.z;
  }
}

TEST(BoundaryDistance, tells_the_side_in_a_thin_gap) {
  ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 4);
  surfaces::append(surface, surfaces::box({-0.999, -0.999, -0.999}, {0.999, 0.999, 0.999}, 3, 3, 3),
                   surfaces::Turn::inward);
  const BoundaryDistance boundary(surface.points, surface.triangles);
  for (const double z : {0.9991, 0.9995, 0.9999}) {
    for (double x = -0.93; x < 0.95; x += 0.111) {
      EXPECT_TRUE(boundary.inside({x, 0.3, z}));
      EXPECT_TRUE(boundary.inside({x, 0.3, -z}, boundary.nearest({x, 0.3, -z})));
    }
  }
  EXPECT_FALSE(boundary.inside({0, 0, 0.9989}));
  EXPECT_FALSE(boundary.inside({0, 0, 1.0001}));
}

TEST(BoundaryDistance, finds_any_triangle_within_its_own_limit) {
  const ClosedSurface surface = surfaces::sphere({0, 0, 0}, 1, 8);
  const BoundaryDistance boundary(surface.points, surface.triangles);
  const auto limit_of_one = [](std::int32_t only) {
    return [only](std::int32_t t) { return t == only ? 0.6 : 0.0; };
  };
  for (std::int32_t t = 0; t < 50; ++t) {
    const auto& v = surface.triangles[t];
    const Vec3 center = (1.0 / 3.0) * (surface.points[v[0]] + surface.points[v[1]] + surface.points[v[2]]);
    EXPECT_TRUE(boundary.any_nearer(0.5 * center, 0.6, limit_of_one(t)));
    EXPECT_FALSE(boundary.any_nearer(0.3 * center, 0.6, limit_of_one(t)));
    EXPECT_FALSE(boundary.any_nearer(-0.5 * center, 0.6, limit_of_one(t)));
  }
}

}  // namespace
}  // namespace aeroloom::volume
