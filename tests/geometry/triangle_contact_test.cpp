// The place where two triangles meet.
#include "geometry/triangle_contact.hpp"

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

const Vec3 floor[3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

void expect_at(const Vec3 (&other)[3], Vec3 place) {
  for (const Vec3 found : {place_of_meeting(floor, other), place_of_meeting(other, floor)})
    EXPECT_LT(distance(found, place), 1e-12) << found.x << ' ' << found.y << ' ' << found.z;
}

TEST(TriangleContactLocal, IsWhereACornerTouches) {
  expect_at({{0.3, 0.2, 0}, {0.5, 0.2, 1}, {0.3, 0.5, 1}}, {0.3, 0.2, 0});
}

TEST(TriangleContactLocal, IsTheMiddleOfACrossing) {
  expect_at({{1, 1, -1}, {1, 1, 1}, {1.5, 1, 0}}, {1.25, 1, 0});
}

TEST(TriangleContactLocal, IsWhereTrianglesOfOnePlaneMeet) {
  expect_at({{-1, -1, 0}, {0, 0, 0}, {-1, 0, 0}}, {0, 0, 0});
}

TEST(TriangleContactLocal, IsHalfWayBetweenTrianglesThatNearlyMeet) {
  expect_at({{1, 1, 0.2}, {1, 2, 1}, {2, 1, 1}}, {1, 1, 0.1});
  expect_at({{-0.2, 1, -1}, {-0.2, 1, 1}, {-1, 1, 0}}, {-0.1, 1, 0});
}

}  // namespace
}  // namespace aeroloom::geometry
