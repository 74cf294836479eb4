#include "surface/charts/chart_division.hpp"

#include "surface/charts/conformal_map.hpp"
#include "surface/charts/surface_topology.hpp"

#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::surface {
namespace {

/// A ribbon along a circle in space that rises, seen from above: it lies on itself where it goes more than
/// once around. All points of its border are mesh vertices.
Chart ribbon(double turns, int segments) {
  Chart chart;
  ChartSurface& surface = chart.surface;
  for (int i = 0; i <= segments; ++i) {
    const double angle = 2 * std::numbers::pi * turns * i / segments;
    for (const double radius : {1.0, 1.3}) {
      // A spiral, so that its ends cross and do not only lie side by side.
      const double r = radius + 0.1 * i / segments;
      surface.mesh_vertex.push_back(static_cast<std::int32_t>(surface.points.size()));
      surface.points.push_back({r * std::cos(angle), r * std::sin(angle), 0.5 * i / segments});
      chart.plane.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
  }
  for (int i = 0; i < segments; ++i) {
    surface.triangles.push_back({2 * i, 2 * i + 1, 2 * i + 3});
    surface.triangles.push_back({2 * i, 2 * i + 3, 2 * i + 2});
  }
  surface.corner_uv.resize(surface.triangles.size());
  surface.loop_edges = trace_loop_edges(surface);
  return chart;
}

TEST(ChartDivision, FindsNoFoldInARibbonThatIsFlat) {
  const Chart chart = ribbon(0.8, 40);
  EXPECT_FALSE(find_fold(chart, {{0, 5}}));
}

TEST(ChartDivision, FindsWhereARibbonLiesOnItself) {
  const Chart chart = ribbon(1.2, 60);
  const auto fold = find_fold(chart, {});
  ASSERT_TRUE(fold);
  ASSERT_TRUE(fold->meeting);
  // The two edges are near in the plane, and far from each other over the ribbon.
  const auto& [first, second] = fold->meeting->edges;
  EXPECT_LT(distance(chart.plane[first[0]], chart.plane[second[0]]), 0.3);
  EXPECT_GT(std::abs(first[0] - second[0]), 60);
}

TEST(ChartDivision, LooksOnlyAtTheChordsThatItIsAskedFor) {
  const Chart chart = ribbon(1.2, 60);
  const auto number = [&](std::int32_t from) {
    for (std::size_t e = 0; e < chart.surface.loop_edges.size(); ++e) {
      if (chart.surface.loop_edges[e][0] == from) return static_cast<std::int32_t>(e);
    }
    return -1;
  };
  EXPECT_FALSE(find_fold(chart, {{number(61), number(63)}}));
}

TEST(ChartDivision, FindsATriangleThatIsTurnedOverBesideTheChords) {
  Chart chart = ribbon(0.8, 40);
  chart.plane[1] = {0.5, 0.2};  // over the inner side
  EXPECT_TRUE(find_fold(chart, {{0, 5}}));
}

TEST(ChartDivision, LevelsPartTheTwoEdgesInTheMiddle) {
  const Chart chart = ribbon(1.2, 60);
  const BorderMeeting ends{{std::array<std::int32_t, 2>{1, 0}, std::array<std::int32_t, 2>{120, 121}}};
  const std::vector<double> levels = medial_levels(chart.surface, ends);
  for (std::size_t i = 0; i < 56; ++i) EXPECT_LT(levels[i], 0) << i;
  for (std::size_t i = 67; i < levels.size(); ++i) EXPECT_GT(levels[i], 0) << i;
}

}  // namespace
}  // namespace aeroloom::surface
