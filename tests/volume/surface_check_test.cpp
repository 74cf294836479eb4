#include "volume/surface_check.hpp"

#include "tests/volume/surfaces.hpp"

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

SurfaceDefect intersections(const ClosedSurface& surface) {
  return find_intersections(surface, BoundaryDistance(surface.points, surface.triangles));
}

TEST(SurfaceCheck, accepts_sound_surfaces) {
  for (const ClosedSurface& surface : {surfaces::cube({0, 0, 0}, 1, 3), surfaces::cube_with_ball(6, 5)}) {
    EXPECT_EQ(find_defect(surface).what, "");
    EXPECT_EQ(intersections(surface).what, "");
  }
}

TEST(SurfaceCheck, names_the_triangles_around_a_hole) {
  ClosedSurface surface = surfaces::sphere({0, 0, 0}, 1, 3);
  surface.triangles.pop_back();
  const SurfaceDefect defect = find_defect(surface);
  EXPECT_NE(defect.what.find("open"), std::string::npos);
  EXPECT_EQ(defect.triangles.size(), 3u);
}

TEST(SurfaceCheck, finds_turned_triangles) {
  ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 3);
  std::swap(surface.triangles[7][0], surface.triangles[7][1]);
  const SurfaceDefect defect = find_defect(surface);
  EXPECT_NE(std::find(defect.triangles.begin(), defect.triangles.end(), 7), defect.triangles.end());
}

TEST(SurfaceCheck, finds_bad_points_and_triangles) {
  ClosedSurface twice = surfaces::cube({0, 0, 0}, 1, 3);
  surfaces::append(twice, surfaces::cube({2, 0, 0}, 1, 3));
  EXPECT_NE(find_defect(twice).what.find("same place"), std::string::npos);

  ClosedSurface flat = surfaces::cube({0, 0, 0}, 1, 4);
  const auto t = flat.triangles[4];
  flat.points[t[2]] = 0.5 * (flat.points[t[0]] + flat.points[t[1]]);
  EXPECT_NE(find_defect(flat).what.find("area"), std::string::npos);

  ClosedSurface loose = surfaces::cube({0, 0, 0}, 1, 3);
  loose.points.push_back({0, 0, 0});
  EXPECT_NE(find_defect(loose).what.find("no triangle"), std::string::npos);

  ClosedSurface infinite = surfaces::cube({0, 0, 0}, 1, 3);
  infinite.points[infinite.triangles[8][0]].y = std::nan("");
  EXPECT_NE(find_defect(infinite).what.find("finite"), std::string::npos);

  ClosedSurface wild = surfaces::cube({0, 0, 0}, 1, 3);
  wild.triangles[5][1] = 1000000;
  EXPECT_EQ(find_defect(wild).triangles, std::vector<std::int32_t>{5});
  EXPECT_NE(describe_triangles(wild, {5}).find("triangle 5"), std::string::npos);
}

TEST(SurfaceCheck, finds_crossing_shells) {
  ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 4);
  const auto first = static_cast<std::int32_t>(surface.triangles.size());
  surfaces::append(surface, surfaces::sphere({1, 0, 0}, 0.3, 3));
  const SurfaceDefect defect = intersections(surface);
  ASSERT_FALSE(defect.triangles.empty());
  for (const std::int32_t t : defect.triangles) {
    double nearest = 10;
    for (const auto v : surface.triangles[t])
      nearest = std::min(nearest, norm(surface.points[v] - geometry::Vec3{1, 0, 0}));
    EXPECT_LT(nearest, 0.75);
  }
  EXPECT_LT(defect.triangles.front(), first);
  EXPECT_GE(defect.triangles.back(), first);
}

TEST(SurfaceCheck, finds_a_point_pushed_through_the_other_side) {
  ClosedSurface surface = surfaces::box({0, 0, 0}, {4, 4, 1}, 8, 8, 2);
  for (auto& p : surface.points) {
    if (p == geometry::Vec3{2, 2, 1}) p.z = -0.2;
  }
  EXPECT_FALSE(intersections(surface).triangles.empty());
}

TEST(SurfaceCheck, finds_a_fold) {
  ClosedSurface surface = surfaces::cube({0, 0, 0}, 1, 4);
  for (auto& p : surface.points) {
    if (p == geometry::Vec3{0, 0, 1}) p.x = 0.6;
  }
  EXPECT_FALSE(intersections(surface).triangles.empty());
}

}  // namespace
}  // namespace aeroloom::volume
