#include "surface/front/delaunay.hpp"

#include "geometry/predicates.hpp"

#include <random>

#include <gtest/gtest.h>

namespace aeroloom::front {
namespace {

using geometry::Vec2;

TEST(Delaunay, KeepsCirclesEmptyOnAGrid) {
  std::vector<Vec2> points;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) points.push_back({double(i), double(j)});
  }
  const Delaunay plane(points);
  EXPECT_FALSE(plane.has_duplicates());
  ASSERT_EQ(plane.mesh.triangles.size(), 2 * (points.size() + 4) - 2 - 4);
  for (const auto& triangle : plane.mesh.triangles) {
    const auto& v = triangle.vertices;
    ASSERT_GT(geometry::orient2d(plane.points[v[0]], plane.points[v[1]], plane.points[v[2]]), 0);
    for (const Vec2 p : points) {
      ASSERT_LE(geometry::in_circle(plane.points[v[0]], plane.points[v[1]], plane.points[v[2]], p), 0);
    }
  }
}

TEST(Delaunay, RecoversEdgesThatAreNotDelaunay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec2> points{{-1, 0.5}, {2, 0.5}, {0.5, -1}, {0.5, 2}};
  for (int i = 0; i < 500; ++i) points.push_back({unit(random), unit(random)});
  Delaunay plane(points);
  EXPECT_TRUE(plane.recover(0, 1));
  EXPECT_NE(plane.mesh.find(0, 1), geometry::no_linked_edge);
  EXPECT_TRUE(plane.mesh.is_fixed(plane.mesh.find(1, 0)));
  EXPECT_FALSE(plane.recover(2, 3)) << "it crosses the first";
  for (const auto& triangle : plane.mesh.triangles) {
    const auto& v = triangle.vertices;
    ASSERT_GT(geometry::orient2d(plane.points[v[0]], plane.points[v[1]], plane.points[v[2]]), 0);
  }
}

}  // namespace
}  // namespace aeroloom::front
