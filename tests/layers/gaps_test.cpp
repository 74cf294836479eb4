#include "layers/gaps.hpp"

#include "tests/meshes/wall_meshes.hpp"
#include "tests/several_ranks.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

TEST(TouchingBallsLocal, AreAsLargeAsTheDistanceOfParallelWalls) {
  const Vec3 opposite[3] = {{-5, -5, 2}, {5, -5, 2}, {0, 5, 2}};
  EXPECT_NEAR(diameter_beside({{0, 0, 0}, {0, 0, 1}, 10}, opposite), 2, 1e-5);
  EXPECT_EQ(diameter_beside({{0, 0, 0}, {0, 0, 1}, 1.5}, opposite), 1.5) << "out of reach";
  EXPECT_EQ(diameter_beside({{0, 0, 0}, {0, 0, -1}, 10}, opposite), 10) << "behind the wall";
}

TEST(TouchingBallsLocal, AreTwiceTheDistanceFromTheOtherSideOfACorner) {
  const Vec3 side[3] = {{1, -9, 0}, {1, 9, 0}, {1, 0, 30}};
  EXPECT_NEAR(diameter_beside({{0, 0, 0}, {0, 0, 1}, 10}, side), 2, 1e-5);
}

TEST(TouchingBallsLocal, DoNotMindAFlatOrConvexWall) {
  EXPECT_EQ(diameter_beside({{0, 0, 0}, {0, 0, 1}, 10}, {{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}), 10);
  EXPECT_EQ(diameter_beside({{0, 0, 0}, {0, 0, 1}, 10}, {{1, 0, -0.1}, {2, 0, -0.5}, {1, 1, -0.2}}), 10);
}

// It rises from a distance of 1. The ball touches it as far up from there.
TEST(TouchingBallsLocal, DoNotMindAWallThatTurnsALittle) {
  const auto beside = [](double degrees) {
    const double turn = degrees * std::numbers::pi / 180, x = 1 + 30 * std::cos(turn),
                 z = 30 * std::sin(turn);
    return diameter_beside({{0, 0, 0}, {0, 0, 1}, 10}, {{1, -9, 0}, {1, 9, 0}, {x, 0, z}});
  };
  EXPECT_NEAR(beside(60), 2 / std::tan(std::numbers::pi / 6), 1e-5);
  EXPECT_EQ(beside(30), 10);
}

/// Plates of thickness 1 with a slit of 0.25 between, in a large box.
examples::Shapes slit() {
  return examples::Shapes()
      .add_box({-5, -5, -5}, {7, 7, 7}, {3, 3, 3}, examples::Fluid::inside)
      .add_box({0, 0, 0}, {2, 2, 1}, {6, 6, 3}, examples::Fluid::outside)
      .add_box({0, 0, 1.25}, {2, 2, 2.25}, {6, 6, 3}, examples::Fluid::outside);
}

std::vector<double> gaps_in_slit(const mesh::DistributedMesh& mesh) {
  const LocalWall wall(mesh, {});
  std::vector<TouchingBall> balls(wall.points.size());
  for (std::size_t v = 0; v < balls.size(); ++v) {
    const Vec3 p = wall.points[v];
    if (p.z == 1 && p.x > 0.5 && p.x < 1.5 && p.y > 0.5 && p.y < 1.5) balls[v] = {p, {0, 0, 1}, 1};
    if (p.z == 0 && p.x > 0.5 && p.x < 1.5 && p.y > 0.5 && p.y < 1.5) balls[v] = {p, {0, 0, -1}, 1};
  }
  return find_gaps(wall, balls);
}

TEST(Gaps, SeeTheOtherPlateOnAnyRank) {
  const auto world = parallel::Communicator::world();
  const mesh::DistributedMesh mesh = slit().distribute(world, 6);
  const std::vector<double> gaps = gaps_in_slit(mesh);
  std::int64_t narrow = 0;
  std::size_t v = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    for (mesh::LocalIndex i = 0; i < piece.vertex_count(); ++i, ++v) {
      const Vec3 p = piece.point(i);
      if (gaps[v] == 0) continue;
      EXPECT_NEAR(gaps[v], p.z == 1 ? 0.25 : 1.0, 1e-6);
      narrow += p.z == 1;
    }
  }
  EXPECT_GT(world.sum(narrow), 4);
}

TEST(Gaps, AreTheSameOnAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto world = parallel::Communicator::world(), self = parallel::Communicator::self();
  const mesh::DistributedMesh mesh = slit().distribute(world, 6), whole = slit().distribute(self, 6);
  const std::vector<double> gaps = gaps_in_slit(mesh), expected = gaps_in_slit(whole);
  std::size_t v = 0;
  for (const mesh::Piece& piece : mesh.pieces) {
    std::size_t at = 0;
    for (const mesh::Piece& other : whole.pieces) {
      if (other.id == piece.id) break;
      at += other.vertex_count();
    }
    for (mesh::LocalIndex i = 0; i < piece.vertex_count(); ++i) EXPECT_EQ(gaps[v++], expected[at + i]);
  }
}

}  // namespace
}  // namespace aeroloom::layers
