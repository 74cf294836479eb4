#include "volume/filling/surface_check.hpp"

#include "tests/meshes/surfaces.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

TriangleSoup part(const surfaces::Surface& surface) {
  return {surface.points, surface.triangles};
}

SurfaceDefect defect(const surfaces::Surface& surface) {
  return find_defect(part(surface));
}

SurfaceDefect intersections(const surfaces::Surface& surface) {
  return find_intersections(part(surface), BoundaryDistance(surface.points, surface.triangles));
}

TEST(SurfaceCheck, accepts_sound_surfaces) {
  for (const surfaces::Surface& surface : {surfaces::cube({0, 0, 0}, 1, 3), surfaces::cube_with_ball(6, 5)}) {
    EXPECT_EQ(defect(surface).what, "");
    EXPECT_EQ(intersections(surface).what, "");
  }
}

TEST(SurfaceCheck, does_not_mind_an_open_part) {
  surfaces::Surface surface = surfaces::sphere({0, 0, 0}, 1, 3);
  surface.triangles.resize(surface.triangles.size() / 2);
  EXPECT_EQ(defect(surface).what, "");
  EXPECT_EQ(intersections(surface).what, "");
}

TEST(SurfaceCheck, finds_bad_points_and_triangles) {
  surfaces::Surface twice = surfaces::cube({0, 0, 0}, 1, 3);
  surfaces::append(twice, surfaces::cube({2, 0, 0}, 1, 3));
  EXPECT_NE(defect(twice).what.find("same place"), std::string::npos);

  surfaces::Surface flat = surfaces::cube({0, 0, 0}, 1, 4);
  const auto t = flat.triangles[4];
  flat.points[t[2]] = 0.5 * (flat.points[t[0]] + flat.points[t[1]]);
  EXPECT_NE(defect(flat).what.find("area"), std::string::npos);

  surfaces::Surface infinite = surfaces::cube({0, 0, 0}, 1, 3);
  infinite.points[infinite.triangles[8][0]].y = std::nan("");
  EXPECT_NE(defect(infinite).what.find("finite"), std::string::npos);

  surfaces::Surface wild = surfaces::cube({0, 0, 0}, 1, 3);
  wild.triangles[5][1] = 1000000;
  EXPECT_EQ(defect(wild).triangles, std::vector<std::int32_t>{5});
  EXPECT_NE(describe_triangles(part(wild), {5}).find("triangle 5"), std::string::npos);
}

TEST(SurfaceCheck, finds_crossing_shells) {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 4);
  const auto first = static_cast<std::int32_t>(surface.triangles.size());
  surfaces::append(surface, surfaces::sphere({1, 0, 0}, 0.3, 3));
  const SurfaceDefect found = intersections(surface);
  ASSERT_FALSE(found.triangles.empty());
  EXPECT_NE(found.what.find("intersects itself"), std::string::npos);
  for (const std::int32_t t : found.triangles) {
    double nearest = 10;
    for (const auto v : surface.triangles[t])
      nearest = std::min(nearest, norm(surface.points[v] - geometry::Vec3{1, 0, 0}));
    EXPECT_LT(nearest, 0.75);
  }
  EXPECT_LT(found.triangles.front(), first);
  EXPECT_GE(found.triangles.back(), first);
}

TEST(SurfaceCheck, finds_a_point_pushed_through_the_other_side) {
  surfaces::Surface surface = surfaces::box({0, 0, 0}, {4, 4, 1}, {8, 8, 2});
  for (auto& p : surface.points) {
    if (p == geometry::Vec3{2, 2, 1}) p.z = -0.2;
  }
  EXPECT_FALSE(intersections(surface).triangles.empty());
}

TEST(SurfaceCheck, describes_ten_triangles_and_counts_the_rest) {
  const surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 2);
  std::vector<std::int32_t> many;
  for (std::int32_t t = 0; t < 13; ++t) many.push_back(t);
  const std::string text = describe_triangles(part(surface), many);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 11);
  EXPECT_NE(text.find("and 3 more"), std::string::npos) << text;
  EXPECT_NE(text.find("edges 1 to 1.41"), std::string::npos) << text;
}

TEST(SurfaceCheck, finds_triangles_that_meet_beside_a_common_point) {
  // The edge of one pierces the other.
  surfaces::Surface surface;
  surface.points = {{0, 0, 0}, {2, -1, 0}, {2, 1, 0}, {1, 0, -1}, {1.2, 0.1, 1}};
  surface.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(intersections(surface).triangles, (std::vector<std::int32_t>{0, 1}));
  std::swap(surface.triangles[0], surface.triangles[1]);
  EXPECT_EQ(intersections(surface).triangles, (std::vector<std::int32_t>{0, 1}));
  for (geometry::Vec3& p : surface.points) p.z += p.z < 0 ? 1.5 : 0;
  EXPECT_TRUE(intersections(surface).triangles.empty());
}

TEST(SurfaceCheck, finds_a_fold) {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 4);
  for (auto& p : surface.points) {
    if (p == geometry::Vec3{0, 0, 1}) p.x = 0.6;
  }
  EXPECT_FALSE(intersections(surface).triangles.empty());
}

}  // namespace
}  // namespace aeroloom::volume
