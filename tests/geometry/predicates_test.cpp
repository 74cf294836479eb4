#include "geometry/predicates.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

constexpr double tiny = std::numeric_limits<double>::epsilon();

TEST(Predicates, OrientationInThePlane) {
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orient2d({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orient2d({0, 0}, {1, 1}, {3, 3}), 0);
  EXPECT_EQ(orient2d({0.5, 0.5}, {12, 12}, {24, 24}), 0);
  EXPECT_EQ(orient2d({0.5, 0.5 + tiny}, {12, 12}, {24, 24}), 1) << "one bit above the line";
  EXPECT_EQ(orient2d({0.5, 0.5 - tiny / 2}, {12, 12}, {24, 24}), -1) << "one bit below the line";
}

TEST(Predicates, OrientationInSpaceHasTheSignOfTheVolume) {
  const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0, 1, 0};
  EXPECT_EQ(orient3d(a, b, c, {0, 0, 1}), 1);
  EXPECT_GT(volume6(a, b, c, {0, 0, 1}), 0);
  EXPECT_EQ(orient3d(a, b, c, {0, 0, -1}), -1);
  EXPECT_EQ(orient3d(a, b, c, {0.3, 0.3, 0}), 0);
  EXPECT_EQ(orient3d(a, b, c, {0.3, 0.3, std::numeric_limits<double>::denorm_min()}), 1);
}

TEST(Predicates, OrientationIsAntisymmetricNearDegeneracy) {
  const Vec3 a{0.1, 0.2, 0.3}, b{1.1, 0.7, 0.9}, c{-0.4, 2.2, 1.3};
  for (int i = -20; i <= 20; ++i) {
    const Vec3 d = 0.3 * a + 0.3 * b + 0.4 * c + Vec3{0, 0, i * tiny};
    EXPECT_EQ(orient3d(a, b, c, d), -orient3d(b, a, c, d));
    EXPECT_EQ(orient3d(a, b, c, d), orient3d(b, c, a, d));
  }
}

TEST(Predicates, Circles) {
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}), 1);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {1, 1}), 0);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {1, 1 + tiny}), -1);
  EXPECT_EQ(in_circle({0, 0}, {1, 0}, {0, 1}, {1, 1 - tiny}), 1);
}

struct Pair {
  const char* name;
  Vec3 a[3], b[3];
  bool meet;
};

const Vec3 o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0};
const Pair pairs[] = {
    {"crossing", {o, x, y}, {{0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.3, 0.4, 1}}, true},
    {"above", {o, x, y}, {{0, 0, 0.1}, {1, 0, 0.1}, {0, 1, 0.1}}, false},
    {"touching in a vertex", {o, x, y}, {{0.25, 0.25, 0}, {0, 0, 1}, {1, 0, 1}}, true},
    {"one bit short of touching", {o, x, y}, {{0.25, 0.25, 1e-300}, {0, 0, 1}, {1, 0, 1}}, false},
    {"coplanar and overlapping", {o, x, y}, {{0.1, 0.1, 0}, {2, 0.1, 0}, {0.1, 2, 0}}, true},
    {"coplanar, one inside the other", {o, x, y}, {{0.1, 0.1, 0}, {0.2, 0.1, 0}, {0.1, 0.2, 0}}, true},
    {"coplanar and apart", {o, x, y}, {{2, 0, 0}, {3, 0, 0}, {2, 1, 0}}, false},
    {"coplanar with a common edge", {o, x, y}, {x, y, {1, 1, 0}}, true},
    {"a segment through it", {o, x, y}, {{0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.2, 0.2, 0.5}}, true},
    {"a segment beside it", {o, x, y}, {{0.8, 0.8, -1}, {0.8, 0.8, 1}, {0.8, 0.8, 0.5}}, false},
    {"a point on it", {o, x, y}, {{0.25, 0.25, 0}, {0.25, 0.25, 0}, {0.25, 0.25, 0}}, true},
    {"a point above it", {o, x, y}, {{0.25, 0.25, 1e-9}, {0.25, 0.25, 1e-9}, {0.25, 0.25, 1e-9}}, false},
    {"two crossing segments", {o, x, {0.5, 0, 0}}, {{0.5, -1, 0}, {0.5, 1, 0}, {0.5, 1, 0}}, true},
    {"two skew segments", {o, x, {0.5, 0, 0}}, {{0.5, -1, 0.1}, {0.5, 1, 0.1}, {0.5, 1, 0.1}}, false},
    {"two equal points", {x, x, x}, {x, x, x}, true},
};

TEST(Predicates, TrianglesThatMeet) {
  for (const Pair& pair : pairs) {
    const Vec3 turned[3] = {pair.b[2], pair.b[1], pair.b[0]};
    EXPECT_EQ(triangles_intersect(pair.a, pair.b), pair.meet) << pair.name;
    EXPECT_EQ(triangles_intersect(pair.b, pair.a), pair.meet) << pair.name;
    EXPECT_EQ(triangles_intersect(pair.a, turned), pair.meet) << pair.name;
  }
}

TEST(Predicates, SegmentsThatMeetTriangles) {
  const Vec3 triangle[3] = {o, x, y};
  const Vec3 flat[3] = {o, x, {0.5, 0, 0}};
  EXPECT_TRUE(segment_meets_triangle({0.2, 0.2, -1}, {0.2, 0.2, 1}, triangle));
  EXPECT_TRUE(segment_meets_triangle({0.2, 0.2, 0}, {0.2, 0.2, 1}, triangle));
  EXPECT_TRUE(segment_meets_triangle({-1, 0.2, 0}, {2, 0.2, 0}, triangle)) << "in its plane";
  EXPECT_FALSE(segment_meets_triangle({0.2, 0.2, 1e-300}, {0.2, 0.2, 1}, triangle));
  EXPECT_TRUE(segment_meets_triangle({0.2, 0.2, 0}, {0.2, 0.2, 0}, triangle)) << "a point";
  EXPECT_TRUE(segment_meets_triangle({0.5, 0, -1}, {0.5, 0, 1}, flat)) << "a triangle that is a segment";
  EXPECT_FALSE(segment_meets_triangle({0.5, 0.1, -1}, {0.5, 0.1, 1}, flat));
}

}  // namespace
}  // namespace aeroloom::geometry
