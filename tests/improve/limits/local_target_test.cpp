#include "improve/limits/local_target.hpp"

#include "improve/limits/change_limits.hpp"
#include "tests/improve/pieces.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

const mesh::TetQuality measure(28);
constexpr double width = 0.04;

/// A triangle of length 1 between two curves, where `corners_on` is an edge, and apexes over it at the
/// given heights, from vertex 3 on; one tetrahedron for each.
mesh::Piece make_strip(const std::vector<double>& heights, mesh::CadDimension corners_on) {
  std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0.5, width, 0}};
  std::vector<LocalIndex> cells;
  for (const double height : heights) {
    cells.insert(cells.end(), {0, 1, 2, static_cast<LocalIndex>(points.size())});
    points.push_back({0.5, 0.5 * width, height});
  }
  mesh::Piece piece = examples::make_piece(points, cells);
  std::fill_n(piece.vertex_dimension.begin(), 3, corners_on);
  piece.boundary = {0, 2, 1};
  piece.triangle_face = piece.triangle_patch = {0};
  return piece;
}

TEST(LocalTarget, FallsWithTheWidthOfAStrip) {
  const LocalTarget local_target(make_strip({1}, mesh::CadDimension::edge), measure);
  const double least = std::sqrt(width), target = measure.target();
  EXPECT_NEAR(local_target(Corners{0, 1, 2, 3}), least, 1e-6);
  EXPECT_NEAR(local_target(Corners{0, 1, 3, 4}), std::cbrt(least * least * target), 1e-6);
  EXPECT_NEAR(local_target(Corners{0, 3, 4, 5}), std::cbrt(least * target * target), 1e-6);
  EXPECT_EQ(local_target(Corners{3, 4, 5, 6}), target);
  EXPECT_TRUE(local_target.is_limited(Corners{0, 3, 4, 5}));
  EXPECT_FALSE(local_target.is_limited(Corners{3, 4, 5, 6}));
}

TEST(LocalTarget, IsTheTargetWhereTrianglesMayBecomeOthers) {
  const LocalTarget local_target(make_strip({1}, mesh::CadDimension::face), measure);
  EXPECT_EQ(local_target(Corners{0, 1, 2, 3}), measure.target());
}

TEST(LocalTarget, IsTheTargetBesideWiderStrips) {
  mesh::Piece piece = make_strip({1}, mesh::CadDimension::edge);
  piece.coordinates[3 * 2 + 1] = 0.2;
  EXPECT_EQ(LocalTarget(piece, measure)(Corners{0, 1, 2, 3}), measure.target());
}

/// Replaces the first tetrahedron by so many of the second.
CavityReplacement replace_first(const TetMesh& mesh, std::size_t count) {
  CavityReplacement cavity;
  cavity.old_tets = {0};
  cavity.new_tets.assign(count, mesh.corners(1));
  cavity.before = mesh.quality(0);
  cavity.after = mesh.quality(1);
  return cavity;
}

TEST(LocalTarget, RefusesWhatLeavesMoreToImprove) {
  mesh::Piece piece = make_strip({0.65, 0.5}, mesh::CadDimension::edge);
  const LocalTarget local_target(piece, measure);
  TetMesh mesh(piece, measure, false);
  ASSERT_FALSE(local_target.is_severe(mesh.quality(0)));
  ASSERT_GT(mesh.quality(1), mesh.quality(0));
  ASSERT_LT(mesh.quality(1), local_target(mesh.corners(1)));
  EXPECT_TRUE(local_target.accepts(mesh, replace_first(mesh, 1)));
  EXPECT_FALSE(local_target.accepts(mesh, replace_first(mesh, 5)));

  mesh::Piece elsewhere = make_strip({0.65, 0.5}, mesh::CadDimension::face);
  const LocalTarget target(elsewhere, measure);
  TetMesh other(elsewhere, measure, false);
  EXPECT_TRUE(target.accepts(other, replace_first(other, 5)))
      << "away from narrow regions the worst alone counts";
}

TEST(LocalTarget, LetsSevereCasesCostOthers) {
  mesh::Piece piece = make_strip({2, 0.5}, mesh::CadDimension::edge);
  const LocalTarget local_target(piece, measure);
  TetMesh mesh(piece, measure, false);
  ASSERT_TRUE(local_target.is_severe(mesh.quality(0)));
  EXPECT_TRUE(local_target.accepts(mesh, replace_first(mesh, 20)));
}

/// Whether a tetrahedron of the first height may become one of the second.
bool may_get_flatter(double from, double to, bool severe, Effort effort) {
  mesh::Piece piece = make_strip({from, to}, mesh::CadDimension::edge);
  const LocalTarget local_target(piece, measure);
  TetMesh mesh(piece, measure, false);
  const CavityReplacement cavity = replace_first(mesh, 1);
  EXPECT_EQ(local_target.is_severe(cavity.before), severe);
  EXPECT_FALSE(ChangeLimits().allow(mesh, cavity)) << "away from narrow regions";
  return ChangeLimits(nullptr, &local_target, effort).allow(mesh, cavity);
}

TEST(LocalTarget, LetsSevereCasesGetFlatter) {
  EXPECT_TRUE(may_get_flatter(0.9, 0.1, true, Effort::reduced));
}

TEST(LocalTarget, LetsOthersGetFlatterWithFullEffort) {
  EXPECT_FALSE(may_get_flatter(0.45, 0.25, false, Effort::reduced));
  EXPECT_TRUE(may_get_flatter(0.45, 0.25, false, Effort::full));
}

TEST(LocalTarget, IsTheTargetEverywhereWithFullEffort) {
  const LocalTarget local_target(measure);
  EXPECT_EQ(local_target(Corners{0, 1, 2, 3}), measure.target());
  EXPECT_FALSE(local_target.is_limited(Corners{0, 1, 2, 3}));
}

TEST(LocalTarget, LetsSevereCasesGetFlatterByMoves) {
  mesh::Piece piece = make_strip({0.9}, mesh::CadDimension::edge);
  const LocalTarget local_target(piece, measure);
  TetMesh mesh(piece, measure, false);
  const std::vector<LocalIndex> star{0};
  const Vec3 origin = mesh.point(3);
  mesh.move_vertex(3, {0.5, 0.5 * width, 0.1}, star);
  EXPECT_FALSE(ChangeLimits().allow_move(mesh, 3, star, origin));
  EXPECT_TRUE(ChangeLimits(nullptr, &local_target).allow_move(mesh, 3, star, origin));
}

}  // namespace
}  // namespace aeroloom::improve
