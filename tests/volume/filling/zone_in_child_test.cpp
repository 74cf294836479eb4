/// One try at filling a zone in a sandboxed child: what comes back, and what a failing child leaves behind.
#include "volume/filling/zone_in_child.hpp"

#include "parallel/communication/communicator.hpp"
#include "tests/meshes/surfaces.hpp"
#include "volume/filling/cell_order.hpp"
#include "volume/lattice/boundary_distance.hpp"
#include "volume/volume_mesher.hpp"

#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using parallel::Communicator;
using Fault = parallel::Fault;

/// A cube of edge 2 with random points inside, moved and scaled.
ZoneProblem cube_problem(int points = 300, double scale = 1, Vec3 move = {}) {
  const surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1, 5);
  ZoneProblem problem;
  problem.points = surface.points;
  problem.triangles = surface.triangles;
  problem.inside.assign(surface.triangles.size(), 0);
  problem.outside.assign(surface.triangles.size(), mesh::no_region);
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> place(-0.85, 0.85);
  for (int i = 0; i < points; ++i) problem.points.push_back({place(random), place(random), place(random)});
  problem.regions.assign(points, 0);
  problem.owners.assign(problem.points.size(), Owner::mine);
  for (Vec3& p : problem.points) p = scale * p + move;
  return problem;
}

double volume_of(const ZoneProblem& problem, const ZoneFilling& filling) {
  std::vector<Vec3> points = problem.points;
  points.insert(points.end(), filling.added.begin(), filling.added.end());
  double sum = 0;
  for (const LocalCell& c : filling.owned.cells)
    sum += volume6(points[c[0]], points[c[1]], points[c[2]], points[c[3]]) / 6;
  return sum;
}

TEST(FillZone, fills_a_cube) {
  const ZoneProblem problem = cube_problem();
  const ZoneFilling filling = fill_zone_in_child(problem, Fault::none);
  ASSERT_TRUE(filling.filled) << filling.failure;
  EXPECT_NEAR(volume_of(problem, filling), 8, 1e-11);
  EXPECT_EQ(filling.owned.cells.size(), filling.owned.regions.size());
  EXPECT_EQ(filling.owned.triangles.size(), problem.triangles.size());
  EXPECT_TRUE(std::is_sorted(filling.owned.triangles.begin(), filling.owned.triangles.end()));
  EXPECT_TRUE(filling.added.empty());
  EXPECT_GT(filling.cpu_seconds, 0);
  EXPECT_GT(filling.child_peak_bytes, 0);
}

TEST(FillZone, makes_the_same_cells_anywhere_and_of_any_scale) {
  const auto cells_of = [](const ZoneProblem& problem) {
    const ZoneFilling filling = fill_zone_in_child(problem, Fault::none);
    EXPECT_TRUE(filling.filled) << filling.failure;
    std::set<LocalCell> cells;
    for (LocalCell cell : filling.owned.cells) {
      std::sort(cell.begin(), cell.end());
      cells.insert(cell);
    }
    EXPECT_EQ(cells.size(), filling.owned.cells.size());
    return cells;
  };
  // Coordinates that are not rounded when they are moved and scaled so.
  const auto coarse = [](ZoneProblem problem) {
    for (Vec3& p : problem.points) {
      for (int axis = 0; axis < 3; ++axis) p[axis] = std::ldexp(std::round(std::ldexp(p[axis], 20)), -20);
    }
    return problem;
  };
  const auto moved = [](ZoneProblem problem, double scale, Vec3 by) {
    for (Vec3& p : problem.points) p = scale * p + by;
    return problem;
  };
  ZoneProblem problem = coarse(cube_problem());
  // Cubes of eight points on a sphere: any rounding would decide how they are cut.
  const auto is_near = [](Vec3 p) {
    for (const double x : {-0.5, 0.0, 0.5}) {
      for (const double y : {-0.5, 0.0, 0.5}) {
        if (distance(p, {x, y, 0.25}) < 0.15) return true;
      }
    }
    return false;
  };
  std::erase_if(problem.points, is_near);
  for (int k = 0; k < 72; ++k) {
    const int column = k / 8 % 3 - 1, row = k / 24 - 1;
    const Vec3 center{0.5 * column, 0.5 * row, 0.25};
    problem.points.push_back(center +
                             0.0625 * Vec3{k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0, k & 4 ? 1.0 : -1.0});
  }
  problem.owners.assign(problem.points.size(), Owner::mine);
  problem.regions.assign(problem.points.size() - surfaces::cube({0, 0, 0}, 1, 5).points.size(), 0);
  const auto expected = cells_of(problem);
  EXPECT_EQ(cells_of(moved(problem, 0x1p-30, {0, 0, 0})), expected);
  EXPECT_EQ(cells_of(moved(problem, 0x1p40, {0, 0, 0})), expected);
  EXPECT_EQ(cells_of(moved(problem, 1, {4096, -1024, 2})), expected);
}

TEST(FillZone, keeps_crossings_with_their_cells) {
  ZoneProblem problem = cube_problem();
  for (std::size_t v = 0; v < problem.points.size(); ++v)
    problem.owners[v] = problem.points[v].x < 0.2 ? Owner::mine : Owner::higher;
  const ZoneFilling filling = fill_zone_in_child(problem, Fault::none);
  ASSERT_TRUE(filling.filled) << filling.failure;
  EXPECT_GT(filling.owned.crossings.size(), 50u);
  for (std::size_t i = 0; i < filling.owned.crossings.size(); ++i) {
    const Crossing& crossing = filling.owned.crossings[i];
    const LocalCell& cell = filling.owned.cells[crossing.cell];
    for (int k = 0; k < 4; ++k) {
      // Behind the face no vertex is the zone's own, or the cell there would be, too.
      if (k != crossing.face) {
        EXPECT_EQ(problem.owners[cell[k]], Owner::higher);
      }
    }
    EXPECT_EQ(problem.owners[cell[crossing.face]], Owner::mine);
    if (i > 0) {
      const Crossing& before = filling.owned.crossings[i - 1];
      EXPECT_TRUE(before.cell < crossing.cell ||
                  (before.cell == crossing.cell && before.face < crossing.face));
    }
  }
}

TEST(FillZone, says_why_a_surface_cannot_be_filled) {
  ZoneProblem problem = cube_problem(0);
  const ZoneProblem other = cube_problem(0, 1, {0.7, 0.1, 0.2});
  const auto first = static_cast<mesh::LocalIndex>(problem.points.size());
  problem.points.insert(problem.points.end(), other.points.begin(), other.points.end());
  for (const auto& [a, b, c] : other.triangles)
    problem.triangles.push_back({a + first, b + first, c + first});
  problem.owners.assign(problem.points.size(), Owner::mine);
  problem.inside.assign(problem.triangles.size(), 0);
  problem.outside.assign(problem.triangles.size(), mesh::no_region);
  const ZoneFilling filling = fill_zone_in_child(problem, Fault::none);
  EXPECT_FALSE(filling.filled);
  EXPECT_NE(filling.failure.find("intersect"), std::string::npos) << filling.failure;
  EXPECT_TRUE(filling.owned.cells.empty());
}

TEST(PredictTetrahedraLocal, grows_with_points_and_triangles) {
  ZoneProblem problem = cube_problem(400);
  EXPECT_EQ(predict_tetrahedra(problem), static_cast<std::int64_t>(5.75 * 400 + 2 * 300));
}

// --- the child of the last rank fails, the others go on

struct Injection {
  Fault fault;
  const char* says;
};
class FailingChild : public testing::TestWithParam<Injection> {};

TEST_P(FailingChild, turns_a_failure_into_a_filling_that_says_so) {
  const Communicator world = Communicator::world();
  const bool is_faulty = world.rank() == world.size() - 1;
  const ZoneProblem problem = cube_problem(50);
  // Memory is used up in CPU time, too, and more of it on a slow machine.
  const double seconds = GetParam().fault == Fault::hangs ? 1 : 10;
  const ZoneFilling filling =
      fill_zone_in_child(problem, is_faulty ? GetParam().fault : Fault::none, nullptr, seconds);
  EXPECT_EQ(filling.filled, !is_faulty);
  EXPECT_EQ(filling.failure.empty(), !is_faulty);
  EXPECT_EQ(filling.owned.cells.empty(), is_faulty);
  if (is_faulty) {
    EXPECT_NE(filling.failure.find(GetParam().says), std::string::npos) << filling.failure;
  }
  // The same ranks can still talk and fill.
  EXPECT_EQ(world.sum(std::int64_t{1}), world.size());
  const ZoneFilling again = fill_zone_in_child(problem, Fault::none);
  EXPECT_TRUE(again.filled) << again.failure;
  EXPECT_NEAR(volume_of(problem, again), 8, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(all, FailingChild,
                         testing::Values(Injection{Fault::throws, "injected fault: an exception"},
                                         Injection{Fault::aborts, "crashed"},
                                         Injection{Fault::hangs, "did not end"},
                                         Injection{Fault::exhausts_memory, "memory"}));

// --- the order of cells

TEST(OrderAlongCurveLocal, lists_each_cell_once_and_neighbours_near_each_other) {
  const ZoneProblem problem = cube_problem(2000);
  const TetgenMesh mesh = run_tetgen({&problem.points[0].x, 3 * problem.points.size()}, problem.triangles);
  std::vector<LocalCell> cells = mesh.cells;
  std::shuffle(cells.begin(), cells.end(), std::mt19937_64(1));
  const std::vector<std::uint32_t> order = order_along_curve(problem.points, cells);
  EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), cells.size());
  ASSERT_EQ(order.size(), cells.size());
  const auto center = [&](const LocalCell& c) {
    return 0.25 * (problem.points[c[0]] + problem.points[c[1]] + problem.points[c[2]] + problem.points[c[3]]);
  };
  double before = 0, after = 0;
  for (std::size_t i = 1; i < cells.size(); ++i) {
    before += distance(center(cells[i]), center(cells[i - 1]));
    after += distance(center(cells[order[i]]), center(cells[order[i - 1]]));
  }
  EXPECT_LT(after, 0.15 * before);
  EXPECT_EQ(order_along_curve(problem.points, cells), order);
  EXPECT_TRUE(order_along_curve(problem.points, std::vector<LocalCell>{}).empty());
}

}  // namespace
}  // namespace aeroloom::volume
