#include "surface/charts/plane_cut.hpp"

#include "surface/charts/surface_topology.hpp"

#include <array>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

using geometry::Vec3;

/// A rectangle of nx by ny unit squares, two triangles each; every point on its boundary is a mesh vertex.
ChartSurface rectangle(int nx, int ny) {
  ChartSurface surface;
  const auto at = [nx](int i, int j) { return static_cast<std::int32_t>(j * (nx + 1) + i); };
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const bool is_border = i == 0 || j == 0 || i == nx || j == ny;
      surface.mesh_vertex.push_back(is_border ? static_cast<std::int32_t>(surface.points.size()) : -1);
      surface.points.push_back({double(i), double(j), 0});
    }
  }
  const auto add = [&](const std::array<std::int32_t, 3>& corners) {
    surface.triangles.push_back(corners);
    std::array<geometry::Vec2, 3>& uv = surface.corner_uv.emplace_back();
    for (int k = 0; k < 3; ++k) uv[k] = {surface.points[corners[k]].x, surface.points[corners[k]].y};
  };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      add({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      add({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  surface.loop_edges = trace_loop_edges(surface);
  return surface;
}

/// The areas of both parts; expects no triangle to be turned over.
std::array<double, 2> areas_of_parts(const CutSurface& cut) {
  std::array<double, 2> areas{};
  for (std::size_t t = 0; t < cut.part.size(); ++t) {
    const Vec3 area = area_vector(cut.surface, static_cast<std::int32_t>(t));
    EXPECT_GT(area.z, 0);
    areas[cut.part[t]] += area.z;
  }
  return areas;
}

TEST(PlaneCut, DividesTheTrianglesAlongThePlane) {
  const ChartSurface surface = rectangle(8, 6);
  const auto cut = cut_by_plane(surface, {{1, 0, 0}, 3.3});
  ASSERT_TRUE(cut);
  EXPECT_GT(cut->surface.triangles.size(), surface.triangles.size());
  ASSERT_EQ(cut->part.size(), cut->surface.triangles.size());
  const std::array<double, 2> areas = areas_of_parts(*cut);
  EXPECT_NEAR(areas[0] + areas[1], 48, 1e-12);
  EXPECT_NEAR(areas[0], 3.3 * 6, 2) << "but for its ends, which bend to mesh vertices";
  for (std::size_t t = 0; t < cut->part.size(); ++t) {
    for (const std::int32_t p : cut->surface.triangles[t]) {
      const double x = cut->surface.points[p].x;
      EXPECT_TRUE(cut->part[t] == 0 ? x < 4 : x > 2.5);
    }
  }
  for (std::size_t t = 0; t < cut->part.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = cut->surface.points[cut->surface.triangles[t][k]];
      EXPECT_EQ(cut->surface.corner_uv[t][k].x, p.x);
      EXPECT_EQ(cut->surface.corner_uv[t][k].y, p.y);
    }
  }
}

TEST(PlaneCut, MeetsTheBoundaryInMeshVerticesAlone) {
  const auto cut = cut_by_plane(rectangle(8, 6), {{std::sqrt(0.5), std::sqrt(0.5), 0}, 4.4});
  ASSERT_TRUE(cut);
  std::array<std::set<std::int32_t>, 2> points;
  for (std::size_t t = 0; t < cut->part.size(); ++t) {
    for (const std::int32_t p : cut->surface.triangles[t]) points[cut->part[t]].insert(p);
  }
  int ends = 0;
  for (const std::int32_t p : points[0]) {
    if (!points[1].contains(p)) continue;
    const Vec3 at = cut->surface.points[p];
    if (at.x > 0 && at.x < 8 && at.y > 0 && at.y < 6) continue;
    EXPECT_GE(cut->surface.mesh_vertex[p], 0);
    ++ends;
  }
  EXPECT_EQ(ends, 2);
}

TEST(PlaneCut, LeavesOnePartWhereTheOtherWouldBeSmall) {
  EXPECT_FALSE(cut_by_plane(rectangle(8, 6), {{1, 0, 0}, 9}));
  EXPECT_FALSE(cut_by_plane(rectangle(8, 6), {{std::sqrt(0.5), std::sqrt(0.5), 0}, 0.8}));
  EXPECT_TRUE(cut_by_plane(rectangle(8, 6), {{1, 0, 0}, 2}));
}

TEST(PlaneCut, ALongStripIsCutAcross) {
  const std::vector<CutPlane> planes = propose_planes(rectangle(16, 2));
  ASSERT_FALSE(planes.empty());
  EXPECT_NEAR(std::abs(planes[0].normal.x), 1, 1e-9);
  EXPECT_NEAR(planes[0].offset / planes[0].normal.x, 8, 3);
  EXPECT_TRUE(propose_planes({}).empty());
}

}  // namespace
}  // namespace aeroloom::surface
