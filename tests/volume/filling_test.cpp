#include "volume/filling.hpp"

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;

/// An octahedron of four tetrahedra around its vertical axis.
struct Octahedron {
  std::vector<Vec3> points{{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {0, 0, 1}};
  std::vector<Cell> cells;
  std::vector<Triangle> triangles;

  Octahedron() {
    for (int i = 0; i < 4; ++i) {
      const int j = (i + 1) % 4;
      cells.push_back({4, i, j, 5});
      triangles.push_back({i, j, 5});
      triangles.push_back({j, i, 4});
    }
  }
};

TEST(Filling, accepts_a_right_one) {
  const Octahedron octahedron;
  EXPECT_NO_THROW(check_filling(octahedron.points, octahedron.cells, octahedron.triangles));
}

TEST(Filling, rejects_a_missing_or_doubled_cell) {
  Octahedron octahedron;
  const Cell cell = octahedron.cells.back();
  octahedron.cells.pop_back();
  EXPECT_THROW(check_filling(octahedron.points, octahedron.cells, octahedron.triangles), std::runtime_error);
  octahedron.cells.push_back(cell);
  octahedron.cells.push_back(cell);
  EXPECT_THROW(check_filling(octahedron.points, octahedron.cells, octahedron.triangles), std::runtime_error);
}

TEST(Filling, rejects_inverted_and_flat_cells) {
  Octahedron octahedron;
  std::swap(octahedron.cells[1][0], octahedron.cells[1][1]);
  EXPECT_THROW(check_filling(octahedron.points, octahedron.cells, octahedron.triangles), std::runtime_error);
  Octahedron flat;
  flat.points[0] = {0, -0.5, 0};  // into the plane of its neighbour 3 and the axis
  EXPECT_THROW(check_filling(flat.points, flat.cells, flat.triangles), std::runtime_error);
}

TEST(Filling, rejects_another_boundary) {
  Octahedron octahedron;
  std::swap(octahedron.triangles[3][0], octahedron.triangles[3][1]);
  EXPECT_THROW(check_filling(octahedron.points, octahedron.cells, octahedron.triangles), std::runtime_error);
}

TEST(Filling, takes_the_inner_side_of_each_triangle) {
  const Octahedron octahedron;
  // The octahedron's cells, as if two more lay above two of its faces.
  TetgenMesh mesh;
  mesh.cells = octahedron.cells;
  for (int i = 0; i < 4; ++i) {
    const int before = (i + 3) % 4, after = (i + 1) % 4;
    mesh.neighbours.push_back({-1, after, before, -1});  // opposite to 4, i, i + 1, 5
  }
  mesh.cells.push_back({0, 1, 5, 6});
  mesh.neighbours.push_back({5, 5, 5, -1});
  mesh.cells.push_back({0, 1, 5, 7});
  mesh.neighbours.push_back({4, 4, 4, -1});
  const auto inside = cells_inside(mesh, octahedron.triangles);
  EXPECT_EQ(inside, octahedron.cells);
}

TEST(Filling, rejects_a_leak) {
  const Octahedron octahedron;
  TetgenMesh mesh;
  mesh.cells = {octahedron.cells[0], {0, 1, 5, 6}};
  mesh.neighbours = {{-1, 1, -1, -1}, {0, 0, 0, -1}};
  std::vector<Triangle> triangles = octahedron.triangles;
  triangles.push_back({4, 0, 5});
  EXPECT_THROW(cells_inside(mesh, triangles), std::runtime_error);
}

TEST(Filling, drops_unused_points_but_none_of_the_surface) {
  Octahedron octahedron;
  octahedron.points.push_back({9, 9, 9});
  octahedron.points.push_back({0, 0, 0});
  octahedron.cells.push_back({0, 1, 5, 7});
  const auto used = drop_unused_points(octahedron.points, octahedron.cells, 6);
  EXPECT_EQ(used, (std::vector<std::uint8_t>{1, 1, 1, 1, 1, 1, 0, 1}));
  EXPECT_EQ(octahedron.points.size(), 7u);
  EXPECT_EQ(octahedron.cells.back()[3], 6);
  EXPECT_EQ(octahedron.points[6], (Vec3{0, 0, 0}));
  octahedron.points.push_back({8, 8, 8});
  EXPECT_THROW(drop_unused_points(octahedron.points, octahedron.cells, 8), std::runtime_error);
}

}  // namespace
}  // namespace aeroloom::volume
