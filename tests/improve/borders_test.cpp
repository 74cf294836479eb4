#include "improve/bad_cells.hpp"
#include "improve/border_relaxation.hpp"
#include "improve/cavity_improver.hpp"
#include "tests/improve/shaken.hpp"

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using mesh::DistributedMesh;
using mesh::LocalIndex;
using mesh::Piece;
using parallel::Communicator;

const TetQuality measure(28);
constexpr int pieces = 7;

DistributedMesh shaken(const Communicator& communicator, std::uint32_t seed) {
  return mesh::examples::distribute(communicator, examples::shaken_cube(6, pieces, 0, seed), pieces);
}

std::string hash(const Communicator& communicator, const DistributedMesh& mesh) {
  return mesh::hash_mesh(communicator, mesh, mesh::number_mesh(communicator, mesh));
}

double inverse_ratios(const Communicator& communicator, const DistributedMesh& mesh) {
  double sum = 0;
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* c = piece.cell(t);
      sum += 1 / mesh::mean_ratio(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3]));
    }
  }
  return communicator.sum(sum);
}

double worst(const Communicator& communicator, const DistributedMesh& mesh) {
  double least = 1;
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex t = 0; t < piece.cell_count(); ++t)
      least = std::min(least, quality_of(piece, t, measure));
  }
  return communicator.minimum(least);
}

TEST(BorderRelaxation, LiftsTheAverageAndNeverTheWorst) {
  const auto world = Communicator::world();
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    DistributedMesh mesh = shaken(world, seed);
    double sum = inverse_ratios(world, mesh), least = worst(world, mesh);
    std::int64_t moves = 0;
    for (int pass = 0; pass < 3; ++pass) {
      moves += relax_borders(world, mesh, measure, 1);
      examples::expect_valid(world, mesh);
      const double sum_after = inverse_ratios(world, mesh), least_after = worst(world, mesh);
      EXPECT_LE(sum_after, sum);
      EXPECT_GE(least_after, least);
      sum = sum_after, least = least_after;
    }
    EXPECT_GT(moves, 20);
  }
}

TEST(BorderRelaxation, MovesVerticesThatPiecesShareAndNoOthers) {
  const auto world = Communicator::world();
  DistributedMesh mesh = shaken(world, 11);
  const std::vector<Piece> before = mesh.pieces;
  const std::int64_t moves = relax_borders(world, mesh, measure, 1);
  std::int64_t moved = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const Piece& piece = mesh.pieces[p];
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (piece.point(v) == before[p].point(v)) continue;
      ++moved;
      EXPECT_EQ(piece.vertex_dimension[v], 3);
      EXPECT_TRUE(std::find(piece.shared_vertices.begin(), piece.shared_vertices.end(), v) !=
                  piece.shared_vertices.end());
    }
  }
  // Each is known to two pieces at least, and moves in one of the groups.
  EXPECT_GE(world.sum(moved), 2 * moves);
  EXPECT_GT(moves, 0);
}

TEST(BorderRelaxation, DoesNotDependOnRanks) {
  const auto world = Communicator::world(), self = Communicator::self();
  for (std::uint32_t seed = 20; seed < 25; ++seed) {
    DistributedMesh together = shaken(world, seed), alone = shaken(self, seed);
    const std::int64_t moves = relax_borders(world, together, measure, 2);
    EXPECT_EQ(relax_borders(self, alone, measure, 2), moves);
    EXPECT_EQ(hash(world, together), hash(self, alone));
  }
}

TEST(BorderRelaxation, LeavesASinglePieceAlone) {
  const auto self = Communicator::self();
  DistributedMesh mesh = mesh::examples::distribute(self, examples::shaken_cube(5, 1, 0, 3), 1);
  EXPECT_EQ(relax_borders(self, mesh, measure, 2), 0);
}

TEST(BadCells, FollowRounds) {
  const auto world = Communicator::world();
  for (std::uint32_t seed = 30; seed < 34; ++seed) {
    DistributedMesh mesh =
        mesh::examples::distribute(world, examples::shaken_cube(6, pieces, 25, seed), pieces);
    const ImproveOptions options;
    const MeshSource nowhere;
    CavityImprover improver(mesh, options, nowhere);
    ImproveReport report;
    const auto improve = [&](const cavities::Cavity& cavity) { return improver.improve(cavity, report); };
    BadCells bad(mesh, measure);
    const std::int64_t first = world.sum(bad.state(mesh).bad);
    cavities::CavityWishes wishes;
    parallel::StageClock clock;
    for (int shift = 0; shift < 4; ++shift) {
      if (world.sum(wish_for_bad(mesh, bad, measure, shift, wishes)) == 0) break;
      bad.update(mesh, cavities::refill_cavities(world, mesh, wishes, improve, clock));
      const BadCells fresh(mesh, measure);
      for (std::size_t p = 0; p < mesh.pieces.size(); ++p) EXPECT_EQ(bad.of_piece(p), fresh.of_piece(p));
      BadState all;
      for (const Piece& piece : mesh.pieces) {
        const BadState state = examine(piece, measure);
        all.bad += state.bad;
        all.least_angle = std::min(all.least_angle, state.least_angle);
      }
      EXPECT_EQ(bad.state(mesh).bad, all.bad);
      EXPECT_EQ(bad.state(mesh).least_angle, all.least_angle);
    }
    EXPECT_LT(world.sum(bad.state(mesh).bad), first);
  }
}

}  // namespace
}  // namespace aeroloom::improve
