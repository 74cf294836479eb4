// Unions of closed surfaces: volumes, sources, and what is no body.
#include "geometry/unite_surfaces.hpp"

#include "geometry/predicates.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

ClosedSurface cuboid(Vec3 low, Vec3 high) {
  ClosedSurface surface;
  for (int i = 0; i < 8; ++i)
    surface.points.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  constexpr int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    surface.triangles.push_back({q[0], q[1], q[2]});
    surface.triangles.push_back({q[0], q[2], q[3]});
  }
  return surface;
}

/// Turned about an axis that is none of the coordinates'.
ClosedSurface turned(ClosedSurface surface, double angle) {
  const Vec3 axis = normalized({1, 2, 3});
  for (Vec3& p : surface.points) {
    p = std::cos(angle) * p + std::sin(angle) * cross(axis, p) + (1 - std::cos(angle)) * dot(axis, p) * axis;
  }
  return surface;
}

double volume_of(const ClosedSurface& surface) {
  double volume = 0;
  for (const auto& [a, b, c] : surface.triangles)
    volume += dot(surface.points[a], cross(surface.points[b], surface.points[c])) / 6;
  return volume;
}

TEST(UniteSurfaces, VolumesOfBoxesAddUp) {
  const UnitedSurface united = unite_surfaces(
      {cuboid({0, 0, 0}, {2, 2, 2}), cuboid({1, 1, 1}, {3, 3, 3}), cuboid({2.5, 2.5, 2.5}, {4, 4, 4})},
      1e-12);
  EXPECT_DOUBLE_EQ(volume_of(united.surface), 8 + 8 - 1 + 3.375 - 0.125);
  ASSERT_EQ(united.sources.size(), united.surface.triangles.size());
  int of_each[3] = {};
  for (const TriangleSource& source : united.sources) ++of_each[source.surface];
  for (const int count : of_each) EXPECT_GE(count, 12);
}

TEST(UniteSurfaces, TrianglesLieInTheirSources) {
  const std::vector<ClosedSurface> parts{cuboid({-1, -1, -1}, {1, 1, 1}),
                                         turned(cuboid({-2, -0.3, -0.4}, {2, 0.35, 0.45}), 0.7)};
  const UnitedSurface united = unite_surfaces(parts, 1e-12);
  for (std::size_t t = 0; t < united.sources.size(); ++t) {
    const TriangleSource source = united.sources[t];
    const ClosedSurface& part = parts[source.surface];
    const auto& [a, b, c] = part.triangles[source.triangle];
    const Vec3 normal = normalized(cross(part.points[b] - part.points[a], part.points[c] - part.points[a]));
    for (const std::int32_t p : united.surface.triangles[t])
      EXPECT_NEAR(dot(united.surface.points[p] - part.points[a], normal), 0, 1e-14);
  }
  const UnitedSurface again = unite_surfaces(parts, 1e-12);
  EXPECT_EQ(again.surface.points, united.surface.points);
  EXPECT_EQ(again.surface.triangles, united.surface.triangles);
}

TEST(UniteSurfaces, ACommonFaceVanishes) {
  const UnitedSurface united =
      unite_surfaces({cuboid({0, 0, 0}, {1, 1, 1}), cuboid({1, 0.25, 0.25}, {2, 0.75, 0.75})}, 1e-12);
  EXPECT_DOUBLE_EQ(volume_of(united.surface), 1.25);
}

TEST(UniteSurfaces, WhatIsNoBodyIsRefused) {
  const ClosedSurface unit = cuboid({0, 0, 0}, {1, 1, 1});
  const auto refusal = [&](const ClosedSurface& other) -> std::string {
    try {
      unite_surfaces({unit, other}, 1e-12);
    } catch (const UnionError& error) {
      EXPECT_EQ(error.surface(), 1U);
      return error.what();
    }
    return {};
  };
  EXPECT_NE(refusal(cuboid({1, 1, 0.25}, {2, 2, 0.75})).find("along a line"), std::string::npos);
  ClosedSurface open = cuboid({0.5, 0.5, 0.5}, {2, 2, 2});
  open.triangles.pop_back();
  EXPECT_NE(refusal(open).find("no volume"), std::string::npos);
}

}  // namespace
}  // namespace aeroloom::geometry
