#include "geometry/half_edges.hpp"

#include <gtest/gtest.h>

namespace aeroloom::geometry {
namespace {

TEST(HalfEdges, RunRoundTheirTriangle) {
  for (HalfEdge h = 0; h < 9; ++h) {
    EXPECT_EQ(next_half_edge(h) / 3, h / 3);
    EXPECT_EQ(previous_half_edge(next_half_edge(h)), h);
    EXPECT_EQ(next_half_edge(next_half_edge(next_half_edge(h))), h);
    EXPECT_NE(next_half_edge(h), previous_half_edge(h));
  }
}

TEST(HalfEdges, TwinsRunOppositeWays) {
  const std::vector<TriangleCorners> triangles = {{0, 1, 2}, {2, 1, 3}};
  const std::vector<HalfEdge> twins = match_half_edges(triangles);
  EXPECT_EQ(twins, (std::vector<HalfEdge>{-1, 3, -1, 1, -1, -1}));
}

TEST(HalfEdges, TrianglesTurnedAgainstEachOtherAreNoNeighbours) {
  const std::vector<HalfEdge> twins = match_half_edges({{0, 1, 2}, {1, 2, 3}});
  EXPECT_EQ(twins, std::vector<HalfEdge>(6, -1));
}

TEST(HalfEdges, FourTrianglesAtAnEdgeArePairedInOrder) {
  const std::vector<HalfEdge> twins = match_half_edges({{0, 1, 2}, {0, 1, 3}, {1, 0, 4}, {1, 0, 5}});
  EXPECT_EQ(twins[0], 6);
  EXPECT_EQ(twins[3], 9);
  EXPECT_EQ(twins[6], 0);
  EXPECT_EQ(twins[9], 3);
}

}  // namespace
}  // namespace aeroloom::geometry
