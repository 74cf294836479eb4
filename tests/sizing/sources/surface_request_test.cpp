#include "sizing/sources/surface_request.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::sizing {
namespace {

using geometry::Vec3;

TEST(SurfaceRequest, NearestOfTriangleIsThatOfManyOfItsPoints) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto place = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  for (int round = 0; round < 50; ++round) {
    Triangle t{place(), place(), place()};
    if (round % 5 == 0) t[2] = t[1];  // an edge
    const Vec3 p = 2 * place();
    double least = no_size;
    constexpr int steps = 60;
    for (int i = 0; i <= steps; ++i) {
      for (int j = 0; i + j <= steps; ++j) {
        const double a = double(i) / steps, b = double(j) / steps;
        least = std::min(least, distance(p, a * t[0] + b * t[1] + (1 - a - b) * t[2]));
      }
    }
    const NearestOfTriangle nearest = nearest_of(t, p);
    EXPECT_LE(nearest.away, least + 1e-12);
    EXPECT_GT(nearest.away, least - 0.05);
    const auto& [a, b, c] = nearest.weights;
    EXPECT_NEAR(a + b + c, 1, 1e-12);
    EXPECT_NEAR(distance(p, a * t[0] + b * t[1] + c * t[2]), nearest.away, 1e-9);
  }
}

TEST(SurfaceRequest, AWakeHasItsSizesAlongItsLength) {
  const Vec3 from{0, 0, 0}, to{0, 4, 0};
  const WakeSize wake{"wake", {{}, from, to, {2, 0, 0}, 10, 1.5}, 0.5};
  const SurfaceRequest sheet("wake", wake_sheet({{from, to}}, wake), 0);
  EXPECT_NEAR(sheet.request_in({2, 1, 0}, 1e-3, 1).size, 0.7, 1e-3);
  EXPECT_NEAR(sheet.request_in({8, 3, 0}, 1e-3, 2).size, 2.6, 1e-3);
  EXPECT_EQ(sheet.request_in({8, 3, 0.1}, 1e-3, 1).size, no_size);
  EXPECT_EQ(sheet.request_in({11, 3, 0}, 0.5, 1).size, no_size);
  // A large cube may hold any of its sizes.
  EXPECT_NEAR(sheet.request_in({8, 3, 0}, 8, 1).least, 0.5, 1e-12);
}

TEST(SurfaceRequest, AWakeWithoutAnEndSizeHasOneSize) {
  const WakeSize wake{"wake", {{}, Vec3{0, 0, 0}, Vec3{0, 4, 0}, {1, 0, 0}, 10, {}}, 0.5};
  for (const SizedTriangle& triangle : wake_sheet({{Vec3{0, 0, 0}, Vec3{0, 4, 0}}}, wake))
    EXPECT_EQ(triangle.sizes, (std::array{0.5, 0.5, 0.5}));
}

TEST(SurfaceRequest, ABandEndsAtItsDistance) {
  const SurfaceRequest wall("wall", {{{Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}, {0.2, 0.2, 0.2}}}, 0.5);
  EXPECT_DOUBLE_EQ(wall.request_in({0.2, 0.2, 0.49}, 0, 1).size, 0.2);
  EXPECT_EQ(wall.request_in({0.2, 0.2, 0.51}, 0, 1).size, no_size);
}

}  // namespace
}  // namespace aeroloom::sizing
