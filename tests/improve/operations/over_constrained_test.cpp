#include "improve/operations/over_constrained_removal.hpp"
#include "improve/pieces/over_constrained_trials.hpp"
#include "tests/improve/pieces.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

/// A cube of n^3 small ones, six tetrahedra each: along its edges some have two faces on the boundary.
/// With a shear, two of its angles are smaller.
mesh::Piece six_in_each_cube(int n, double shear = 0) {
  std::vector<Vec3> points;
  const auto at = [n](int i, int j, int k) {
    return static_cast<LocalIndex>((k * (n + 1) + j) * (n + 1) + i);
  };
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) points.push_back({i + shear * j, double(j), double(k)});
    }
  }
  std::vector<LocalIndex> cells;
  for (int cube = 0; cube < n * n * n; ++cube) {
    std::array<int, 3> axes{0, 1, 2};
    do {
      std::array<int, 3> p{cube % n, cube / n % n, cube / n / n};
      cells.push_back(at(p[0], p[1], p[2]));
      for (const int axis : axes) ++p[axis], cells.push_back(at(p[0], p[1], p[2]));
    } while (std::next_permutation(axes.begin(), axes.end()));
  }
  return examples::make_piece(points, cells);
}

int count_over_constrained(const TetMesh& mesh) {
  int count = 0;
  for (LocalIndex t = 0; t < mesh.slot_count(); ++t)
    count += mesh.is_alive(t) && count_boundary_faces(mesh, t) > 1 ? 1 : 0;
  return count;
}

TEST(OverConstrainedRemoval, LeavesFewWithSeveralFacesOnTheBoundary) {
  mesh::Piece piece = six_in_each_cube(4);
  examples::close_boundary(piece);
  const auto triangles = piece.boundary;
  const mesh::TetQuality measure(15);
  TetMesh mesh(piece, measure);
  const int before = count_over_constrained(mesh);
  ASSERT_GT(before, 20);
  const ChangeLimits limits;
  EXPECT_GT(OverConstrainedRemoval(limits).run(mesh), 0);
  EXPECT_LE(count_over_constrained(mesh), before / 10);
  for (LocalIndex t = 0; t < mesh.slot_count(); ++t) {
    if (mesh.is_alive(t)) {
      EXPECT_GE(mesh.quality(t), measure.target());
    }
  }
  mesh.finish();
  EXPECT_NEAR(examples::volume(piece), 64, 1e-9);
  EXPECT_EQ(piece.boundary, triangles);
}

double worst_of(const TetMesh& mesh) {
  double worst = 1;
  for (LocalIndex t = 0; t < mesh.slot_count(); ++t)
    worst = mesh.is_alive(t) ? std::min(worst, mesh.quality(t)) : worst;
  return worst;
}

std::vector<double> boundary_points(const mesh::Piece& piece) {
  std::vector<double> points;
  for (const LocalIndex v : piece.boundary) {
    const Vec3 p = piece.point(v);
    points.insert(points.end(), {p.x, p.y, p.z});
  }
  return points;
}

/// What goes at the cost of angles is kept where they come back to what they were.
TEST(OverConstrainedTrials, RemoveWhatNoSingleChangeDoes) {
  mesh::Piece piece = six_in_each_cube(4, 0.4);
  examples::close_boundary(piece);
  const std::vector<double> triangles = boundary_points(piece);
  TetMesh mesh(piece, mesh::TetQuality(32.6));
  ASSERT_GE(worst_of(mesh), mesh.measure().target());
  const ChangeLimits limits;
  OverConstrainedRemoval(limits).run(mesh);
  const int before = count_over_constrained(mesh);
  ASSERT_GE(before, 10);
  EXPECT_EQ(OverConstrainedTrials(nullptr, 0, Effort::reduced).run(mesh), 0);
  EXPECT_GT(OverConstrainedTrials(nullptr, 20, Effort::reduced).run(mesh), 0);
  EXPECT_LE(count_over_constrained(mesh), before / 8);
  EXPECT_GE(worst_of(mesh), mesh.measure().target());
  mesh.finish();
  EXPECT_NEAR(examples::volume(piece), 64, 1e-9);
  EXPECT_EQ(boundary_points(piece), triangles);
}

/// Where two faces enclose less than twice the target, there is nothing to be tried, and no change is kept
/// that leaves a tetrahedron worse than the worst before.
TEST(OverConstrainedTrials, LeaveWhatIsForced) {
  mesh::Piece piece = six_in_each_cube(4, -1.0);
  examples::close_boundary(piece);
  TetMesh mesh(piece, mesh::TetQuality(28));
  const double worst = worst_of(mesh);
  OverConstrainedTrials(nullptr, 20, Effort::reduced).run(mesh);
  EXPECT_GT(count_over_constrained(mesh), 0);
  EXPECT_GE(worst_of(mesh), std::min(worst, mesh.measure().target()));
}

/// A single tetrahedron gives way to four around a vertex, unless its corners are too sharp for that.
TEST(OverConstrainedRemoval, LeavesWhatTheAnglesForce) {
  const ChangeLimits limits;
  for (const double target : {15.0, 40.0}) {
    mesh::Piece alone = examples::make_piece({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 1, 2, 3});
    examples::close_boundary(alone);
    const mesh::TetQuality measure(target);
    TetMesh mesh(alone, measure);
    EXPECT_EQ(OverConstrainedRemoval(limits).run(mesh), target < 20 ? 1 : 0) << target;
    mesh.finish();
    EXPECT_EQ(alone.cell_count(), target < 20 ? 4 : 1) << target;
    EXPECT_NEAR(examples::volume(alone), 1.0 / 6, 1e-12);
  }
}

/// Pieces are cut between tetrahedra, so one may touch the others of its piece in vertices alone.
TEST(OverConstrainedTrials, ReachATetrahedronThatTouchesOthersInVertices) {
  const std::vector<Vec3> corners{{0, 0, 0}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  std::vector<Vec3> points = corners;
  std::vector<LocalIndex> cells;
  const Vec3 middle{0.5, 0.5, 0.5};
  for (LocalIndex v = 0; v < 4; ++v) {
    cells.push_back(v);
    for (LocalIndex k = 0; k < 4; ++k) {
      if (k == v) continue;
      cells.push_back(static_cast<LocalIndex>(points.size()));
      points.push_back(2 * corners[v] - middle + 0.4 * (corners[k] - middle));
    }
  }
  cells.insert(cells.end(), {0, 1, 2, 3});
  mesh::Piece piece = examples::make_piece(points, cells);
  examples::close_boundary(piece);
  const double volume = examples::volume(piece);
  TetMesh mesh(piece, mesh::TetQuality(15));
  OverConstrainedTrials(nullptr, 20, Effort::reduced).run(mesh);
  mesh.finish();
  EXPECT_GE(piece.cell_count(), 5);
  EXPECT_NEAR(examples::volume(piece), volume, 1e-12);
}

}  // namespace
}  // namespace aeroloom::improve
