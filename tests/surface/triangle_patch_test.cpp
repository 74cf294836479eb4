/// Background triangles of interfaces, meshed by the front kernel.
#include "surface/triangle_patch.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;

/// A straight side in equal parts, or one that bulges by `bulge` along z.
PatchSide side(Vec3 a, Vec3 b, int parts, double bulge = 0) {
  PatchSide result;
  result.straight = bulge == 0;
  for (int i = 0; i <= parts; ++i) {
    const double t = static_cast<double>(i) / parts;
    result.points.push_back((1 - t) * a + t * b + Vec3{0, 0, 4 * bulge * t * (1 - t)});
  }
  return result;
}

std::vector<Vec3> all_points(const std::array<PatchSide, 3>& sides, const PatchMesh& patch) {
  std::vector<Vec3> points;
  for (const PatchSide& s : sides) points.insert(points.end(), s.points.begin(), s.points.end() - 1);
  points.insert(points.end(), patch.inner.begin(), patch.inner.end());
  return points;
}

const Vec3 a{0, 0, 0}, b{1, 0, 0}, c{0.4, 0.9, 0.2};

TEST(TrianglePatch, CoversTheTriangle) {
  const std::array<PatchSide, 3> sides{side(a, b, 10), side(b, c, 10), side(c, a, 10)};
  const PatchMesh patch = fill_triangle(sides, [](Vec3) { return 0.1; });
  const auto points = all_points(sides, patch);
  const Vec3 whole = 0.5 * cross(b - a, c - a);
  double area = 0;
  for (const auto& t : patch.triangles) {
    const Vec3 normal = 0.5 * cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
    EXPECT_GT(dot(normal, whole), 0);
    area += norm(normal);
  }
  EXPECT_NEAR(area, norm(whole), 1e-12);
  EXPECT_NEAR(static_cast<double>(patch.triangles.size()), norm(whole) / (0.433 * 0.01), 25);
}

TEST(TrianglePatch, EndsInItsSides) {
  const std::array<PatchSide, 3> sides{side(a, b, 7), side(b, c, 9), side(c, a, 8, 0.1)};
  const PatchMesh patch = fill_triangle(sides, [](Vec3) { return 0.12; });
  std::map<std::array<std::int32_t, 2>, int> uses;
  for (const auto& t : patch.triangles) {
    for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
  }
  const std::int32_t rim = 7 + 9 + 8;
  for (std::int32_t i = 0; i < rim; ++i) EXPECT_EQ((uses[{i, (i + 1) % rim}]), 1);
  int open = 0;
  for (const auto& [edge, number] : uses) {
    if (number > 0 && !uses.count({edge[1], edge[0]})) ++open;
  }
  EXPECT_EQ(open, rim);
}

TEST(TrianglePatch, BlendsFromACurveToThePlane) {
  const double bulge = 0.08;
  const std::array<PatchSide, 3> sides{side(a, b, 12, bulge), side(b, c, 12), side(c, a, 12)};
  const PatchMesh patch = fill_triangle(sides, [](Vec3) { return 0.08; });
  ASSERT_GT(patch.inner.size(), 20u);
  const Vec3 normal = normalized(cross(b - a, c - a));
  double largest = 0;
  for (const Vec3& p : patch.inner) {
    const double away = std::abs(dot(p - a, normal));
    EXPECT_LE(away, bulge);
    largest = std::max(largest, away);
    if (distance(p, c) < 0.2) {
      EXPECT_LT(away, 0.1 * bulge);
    }
  }
  EXPECT_GT(largest, 0.3 * bulge);
}

TEST(TrianglePatch, OfThreeEdgesIsATriangle) {
  const std::array<PatchSide, 3> sides{side(a, b, 1), side(b, c, 1), side(c, a, 1)};
  const PatchMesh patch = fill_triangle(sides, [](Vec3) { return 2.0; });
  EXPECT_TRUE(patch.inner.empty());
  ASSERT_EQ(patch.triangles.size(), 1u);
}

}  // namespace
}  // namespace aeroloom::surface
