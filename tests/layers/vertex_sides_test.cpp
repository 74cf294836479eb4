#include "layers/vertex_sides.hpp"

#include <set>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

/// Triangles around the origin, whose other corners are named by their place in a list of points.
struct Star {
  std::vector<Vec3> points;
  std::vector<SidedTriangle> triangles;

  /// Counter-clockwise seen from outside of the front region.
  void add(int next, int previous, mesh::RegionId front, mesh::RegionId back) {
    const auto name = [](int i) { return mesh::VertexName{-1, static_cast<std::uint64_t>(i)}; };
    triangles.push_back({name(next), name(previous), points[next], points[previous], front, back,
                         static_cast<mesh::PieceId>(triangles.size()), 0});
  }
  VertexSides sides() const { return find_vertex_sides({}, triangles); }
};

/// Points on the axes: x, y, -x, -y, z, -z.
Star octahedron() {
  return {{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}, {}};
}

/// A disc in the plane z = 0, whose normals point up.
void add_disc(Star& star, mesh::RegionId front, mesh::RegionId back, int quarters = 4) {
  for (int i = 0; i < quarters; ++i) star.add(i, (i + 1) % 4, front, back);
}

TEST(VertexSidesLocal, AFaceBetweenTwoRegionsHasTwo) {
  Star star = octahedron();
  add_disc(star, 3, 5);
  for (const auto& sides : star.sides()) EXPECT_EQ(sides, (std::array{0, 1}));
}

TEST(VertexSidesLocal, ABaffleHasTwoInsideAndOneAtItsRim) {
  Star inside = octahedron();
  add_disc(inside, 0, 0);
  for (const auto& sides : inside.sides()) EXPECT_EQ(sides, (std::array{0, 1}));
  Star rim = octahedron();
  add_disc(rim, 0, 0, 2);
  for (const auto& sides : rim.sides()) EXPECT_EQ(sides, (std::array{0, 0}));
}

TEST(VertexSidesLocal, ABaffleOnAWallPartsTheSpaceBeforeIt) {
  Star star = octahedron();
  add_disc(star, 0, mesh::no_region);
  // A half disc below the plane, across y = 0: its normals point along y.
  star.add(0, 5, 0, 0);
  star.add(5, 2, 0, 0);
  const VertexSides sides = star.sides();
  EXPECT_EQ(sides[0], (std::array{0, -1}));
  EXPECT_EQ(sides[1], (std::array{0, -1}));
  EXPECT_EQ(sides[2], (std::array{1, -1}));
  EXPECT_EQ(sides[3], (std::array{1, -1}));
  EXPECT_EQ(sides[4], sides[5]);
  EXPECT_EQ(std::set<std::int32_t>(sides[4].begin(), sides[4].end()), (std::set<std::int32_t>{0, 1}));
  // y is on the side of the triangles 0 and 1, and normals point there: it is the back.
  EXPECT_EQ(sides[4][1], 0);
}

TEST(VertexSidesLocal, ThreeRegionsInALine) {
  Star star = octahedron();
  // Half planes at the z axis: along x, y and -x; regions 0 between x and y, 1 up to -x, 2 beyond.
  star.add(4, 0, 2, 0), star.add(0, 5, 2, 0);
  star.add(1, 4, 1, 0), star.add(5, 1, 1, 0);
  star.add(2, 4, 2, 1), star.add(5, 2, 2, 1);
  const VertexSides sides = star.sides();
  EXPECT_EQ(sides, (VertexSides{{0, 1}, {0, 1}, {2, 1}, {2, 1}, {0, 2}, {0, 2}}));
}

TEST(VertexSidesLocal, TrianglesThatContradictEachOtherHaveOne) {
  Star star = octahedron();
  add_disc(star, 3, 5, 3);
  star.add(3, 0, 5, 3);
  for (const auto& sides : star.sides()) EXPECT_EQ(sides, (std::array{0, 0}));
}

}  // namespace
}  // namespace aeroloom::layers
