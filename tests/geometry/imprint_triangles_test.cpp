// Triangles that touch are cut along each other: what two of them cover is the same triangles in both.
#include "geometry/imprint_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

using Pair = std::array<std::int32_t, 2>;

double area_of(const std::vector<Vec3>& points, const TriangleCorners& t) {
  return 0.5 * norm(cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
}

/// Areas of the sources' parts, and how often each part occurs, whatever its turn.
struct Parts {
  std::map<std::int32_t, double> area;
  std::map<std::vector<double>, int> uses;
};

Parts parts_of(const ImprintedTriangles& found) {
  Parts parts;
  for (std::size_t t = 0; t < found.triangles.size(); ++t) {
    parts.area[found.sources[t]] += area_of(found.points, found.triangles[t]);
    std::vector<std::array<double, 3>> corners;
    for (const std::int32_t p : found.triangles[t])
      corners.push_back({found.points[p].x, found.points[p].y, found.points[p].z});
    std::sort(corners.begin(), corners.end());
    std::vector<double> key;
    for (const auto& corner : corners) key.insert(key.end(), corner.begin(), corner.end());
    ++parts.uses[key];
  }
  return parts;
}

int shared(const Parts& parts) {
  return static_cast<int>(std::ranges::count_if(parts.uses, [](const auto& use) { return use.second == 2; }));
}

TEST(ImprintTriangles, ASquareWithBothDiagonalsIsFourTrianglesTwice) {
  const std::vector<Vec3> points{{0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {0, 2, 1}};
  const std::vector<TriangleCorners> triangles{{0, 1, 2}, {0, 2, 3}, {1, 0, 3}, {1, 3, 2}};
  const std::vector<Pair> contacts{{0, 2}, {0, 3}, {1, 2}, {1, 3}};
  const ImprintedTriangles found = imprint_triangles(points, triangles, contacts);
  EXPECT_FALSE(found.crossing);
  EXPECT_EQ(found.cut, 4u);
  ASSERT_EQ(found.triangles.size(), 8u);
  const Parts parts = parts_of(found);
  EXPECT_EQ(shared(parts), 4);
  for (const auto& [source, area] : parts.area) EXPECT_NEAR(area, 2, 1e-15);
  for (std::size_t t = 0; t < found.triangles.size(); ++t) {
    const auto& [a, b, c] = found.triangles[t];
    const double up = cross(found.points[b] - found.points[a], found.points[c] - found.points[a]).z;
    EXPECT_EQ(up > 0, found.sources[t] < 2) << "parts are turned as their sources";
  }
}

TEST(ImprintTriangles, ASmallTriangleWithinALargeOneInASlantingPlane) {
  // In the plane x + 2 y + 4 z = 4, with coordinates that are exact.
  const std::vector<Vec3> points{{4, 0, 0}, {0, 2, 0}, {-4, 0, 2}, {1, 0.5, 0.5}, {0, 1, 0.5}, {-1, 0.5, 1}};
  const std::vector<TriangleCorners> triangles{{0, 1, 2}, {3, 5, 4}};
  const ImprintedTriangles found = imprint_triangles(points, triangles, std::vector<Pair>{{0, 1}});
  EXPECT_FALSE(found.crossing);
  const Parts parts = parts_of(found);
  EXPECT_EQ(shared(parts), 1);
  EXPECT_NEAR(parts.area.at(0), area_of(points, triangles[0]), 1e-14);
  EXPECT_EQ(std::count(found.sources.begin(), found.sources.end(), 1), 1);
}

TEST(ImprintTriangles, ASideOnATriangleCutsIt) {
  const std::vector<Vec3> points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, -1, 0}, {1, 2, 0}, {1, 1, 3}};
  const std::vector<TriangleCorners> triangles{{0, 1, 2}, {3, 4, 5}};
  const ImprintedTriangles found = imprint_triangles(points, triangles, std::vector<Pair>{{0, 1}});
  EXPECT_FALSE(found.crossing);
  EXPECT_EQ(found.cut, 2u);  // the second one has a point on its side, where it leaves the first
  const Parts parts = parts_of(found);
  EXPECT_NEAR(parts.area.at(0), 8, 1e-15);
  EXPECT_NEAR(parts.area.at(1), area_of(points, triangles[1]), 1e-15);
  EXPECT_TRUE(std::ranges::any_of(found.points, [](Vec3 p) { return p == Vec3{1, 0, 0}; }));
}

TEST(ImprintTriangles, WhatCrossesIsNamed) {
  const std::vector<Vec3> points{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {2, 1, 0.5}};
  const std::vector<TriangleCorners> triangles{{0, 1, 2}, {3, 4, 5}};
  const ImprintedTriangles found = imprint_triangles(points, triangles, std::vector<Pair>{{0, 1}});
  ASSERT_TRUE(found.crossing);
  EXPECT_EQ(*found.crossing, (Pair{0, 1}));
}

}  // namespace
}  // namespace aeroloom::geometry
