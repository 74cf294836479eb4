/// What TetGen makes of points and triangles.
#include "volume/filling/tetgen_run.hpp"

#include "geometry/predicates.hpp"
#include "tests/volume/zone_problems.hpp"

#include <algorithm>
#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

/// Above zero, but for rounding, where p is inside the sphere through the corners of a positive tetrahedron.
double within_sphere(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 p) {
  a -= p, b -= p, c -= p, d -= p;
  const auto determinant = [](Vec3 u, Vec3 v, Vec3 w) { return dot(u, cross(v, w)); };
  return dot(a, a) * determinant(b, c, d) - dot(b, b) * determinant(a, c, d) +
         dot(c, c) * determinant(a, b, d) - dot(d, d) * determinant(a, b, c);
}

TEST(RunTetgen, gives_positive_cells_that_know_their_neighbours) {
  const ZoneProblem problem = cube_problem();
  const TetgenMesh mesh = run_tetgen(flat(problem.points), problem.triangles);
  EXPECT_TRUE(mesh.added.empty());
  ASSERT_EQ(mesh.cells.size(), mesh.neighbours.size());
  double volume = 0;
  std::vector<int> seen(problem.triangles.size(), 0);
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const LocalCell& cell = mesh.cells[c];
    EXPECT_EQ(geometry::orient3d(problem.points[cell[0]], problem.points[cell[1]], problem.points[cell[2]],
                                 problem.points[cell[3]]),
              1);
    volume += volume_of(cell, problem.points);
    for (int face = 0; face < 4; ++face) {
      const std::int32_t next = mesh.neighbours[c][face];
      ASSERT_NE(next, -1);  // the hull of a cube is its triangles
      if (next <= -2) {
        ++seen[-2 - next];
        EXPECT_EQ(sorted(face_of(cell, face)), sorted(problem.triangles[-2 - next]));
        continue;
      }
      const auto& back = mesh.neighbours[next];
      const auto at = std::find(back.begin(), back.end(), static_cast<std::int32_t>(c));
      ASSERT_NE(at, back.end());
      EXPECT_EQ(sorted(face_of(cell, face)),
                sorted(face_of(mesh.cells[next], static_cast<int>(at - back.begin()))));
    }
  }
  EXPECT_NEAR(volume, 8, 1e-12);
  for (const int count : seen) EXPECT_EQ(count, 1);
}

TEST(RunTetgen, gives_the_delaunay_mesh_of_points_alone_with_their_hull) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(-1, 1);
  std::vector<Vec3> points(150);
  for (Vec3& p : points) p = {place(random), place(random), place(random)};
  const TetgenMesh mesh = run_tetgen(flat(points), {});
  std::set<LocalIndex> on_hull;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    const LocalCell& v = mesh.cells[c];
    for (const Vec3& p : points)
      EXPECT_LE(within_sphere(points[v[0]], points[v[1]], points[v[2]], points[v[3]], p), 1e-12);
    for (int face = 0; face < 4; ++face) {
      if (mesh.neighbours[c][face] != -1) continue;
      const LocalTriangle t = face_of(v, face);
      on_hull.insert(t.begin(), t.end());
      for (const Vec3& p : points)
        EXPECT_LE(geometry::orient3d(points[t[0]], points[t[1]], points[t[2]], p), 0);
    }
  }
  EXPECT_GT(on_hull.size(), 10u);
}

/// Walls of a detail may be that near to each other where the far field is large.
TEST(RunTetgen, keeps_points_apart_that_are_nearer_than_a_billionth_of_the_box) {
  std::vector<Vec3> points;
  for (int corner = 0; corner < 8; ++corner)
    points.push_back({corner % 2 ? 1.0 : -1.0, corner / 2 % 2 ? 1.0 : -1.0, corner / 4 ? 1.0 : -1.0});
  points.push_back({0.1, 0.2, 0.3});
  points.push_back({0.1, 0.2 + 1e-10, 0.3});
  const TetgenMesh mesh = run_tetgen(flat(points), {});
  std::set<LocalIndex> used;
  for (const LocalCell& cell : mesh.cells) used.insert(cell.begin(), cell.end());
  EXPECT_EQ(used.size(), points.size());
}

/// An open sheet: both sides of each triangle are seen.
TEST(RunTetgen, keeps_triangles_that_are_not_closed) {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 3);
  ZoneProblem problem = make_problem(surface, 50, 0.1, [](Vec3) { return 0; });
  for (const Vec3 p : {Vec3{-3, -3, -3}, Vec3{3, -3, -3}, Vec3{0, 3, -3}, Vec3{0, 0, 3}, Vec3{0, -3.5, 3.3}})
    problem.points.push_back(p);
  problem.triangles.resize(problem.triangles.size() / 2);
  const TetgenMesh mesh = run_tetgen(flat(problem.points), problem.triangles);
  std::vector<int> seen(problem.triangles.size(), 0);
  for (const auto& across : mesh.neighbours) {
    for (const std::int32_t next : across) {
      if (next <= -2) ++seen[-2 - next];
    }
  }
  for (const int count : seen) EXPECT_EQ(count, 2);
}

/// Zones overlap: what lies deep within both must be cut alike, also where points are on one sphere.
TEST(RunTetgen, cuts_points_on_a_sphere_by_their_order_whatever_lies_around) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> place(-4, 4);
  std::vector<Vec3> all;
  // Cubes of eight points on a sphere, in an order of their own, and points around.
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p{place(random), place(random), place(random)};
    bool is_near = false;
    for (int k = -1; k <= 1; ++k) is_near = is_near || distance(p, {2.0 * k, 0, 0}) < 0.9;
    if (!is_near) all.push_back(p);
  }
  for (int k = -1; k <= 1; ++k) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 p = Vec3{2.0 * k, 0, 0} +
                     0.25 * Vec3{corner & 1 ? 1.0 : -1.0, corner & 2 ? 1.0 : -1.0, corner & 4 ? 1.0 : -1.0};
      all.insert(all.begin() + static_cast<std::ptrdiff_t>(random() % all.size()), p);
    }
  }
  // The cells within the cubes, as sets of points.
  const auto cut = [](const std::vector<Vec3>& points) {
    std::set<std::array<std::array<double, 3>, 4>> cells;
    const TetgenMesh mesh = run_tetgen(flat(points), {});
    for (const LocalCell& cell : mesh.cells) {
      std::array<std::array<double, 3>, 4> places;
      bool is_inner = true;
      for (int k = 0; k < 4; ++k) {
        const Vec3 p = points[cell[k]];
        places[k] = {p.x, p.y, p.z};
        is_inner = is_inner && std::abs(p.y) == 0.25 && std::abs(p.z) == 0.25;
      }
      std::sort(places.begin(), places.end());
      if (is_inner && places[3][0] - places[0][0] < 1) cells.insert(places);
    }
    return cells;
  };
  const auto expected = cut(all);
  EXPECT_GE(expected.size(), 15u);
  for (const double extent : {1.6, 2.2, 3.0}) {
    std::vector<Vec3> part;
    for (const Vec3& p : all) {
      if (std::max(std::abs(p.y), std::abs(p.z)) < extent && std::abs(p.x) < 2 + extent) part.push_back(p);
    }
    EXPECT_LT(part.size(), all.size());
    EXPECT_EQ(cut(part), expected);
  }
}

}  // namespace
}  // namespace aeroloom::volume
