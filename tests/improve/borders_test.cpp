#include "improve/borders/bad_cells.hpp"
#include "improve/borders/border_smoothing.hpp"
#include "improve/borders/cavity_improver.hpp"
#include "improve/borders/perturbation.hpp"
#include "tests/improve/shaken.hpp"
#include "tests/several_ranks.hpp"

#include <gtest/gtest.h>

namespace aeroloom::improve {
namespace {

using mesh::DistributedMesh;
using mesh::LocalIndex;
using mesh::Piece;
using parallel::Communicator;

const mesh::TetQuality measure(28);
constexpr int pieces = 7;

DistributedMesh shaken(const Communicator& communicator, std::uint32_t seed) {
  return mesh::examples::distribute(communicator, examples::shaken_cube(6, pieces, 0, seed), pieces);
}

std::string hash(const DistributedMesh& mesh) {
  return mesh::hash_mesh(mesh::number_mesh(mesh));
}

std::int64_t relax(DistributedMesh& mesh, int passes) {
  return smooth_borders(mesh, mesh::SharedVertices(mesh), measure, passes);
}

double inverse_ratios(const DistributedMesh& mesh) {
  const Communicator& communicator = mesh.communicator;
  double sum = 0;
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const LocalIndex* c = piece.cell(t);
      sum += 1 / mesh::mean_ratio(piece.point(c[0]), piece.point(c[1]), piece.point(c[2]), piece.point(c[3]));
    }
  }
  return communicator.sum(sum);
}

double worst(const DistributedMesh& mesh) {
  const Communicator& communicator = mesh.communicator;
  double least = 1;
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex t = 0; t < piece.cell_count(); ++t)
      least = std::min(least, quality_of(piece, t, measure));
  }
  return communicator.minimum(least);
}

TEST(BorderSmoothing, LiftsTheAverageAndNeverTheWorst) {
  const auto world = Communicator::world();
  for (std::uint32_t seed = 0; seed < 5; ++seed) {
    DistributedMesh mesh = shaken(world, seed);
    double sum = inverse_ratios(mesh), least = worst(mesh);
    std::int64_t moves = 0;
    for (int pass = 0; pass < 3; ++pass) {
      moves += relax(mesh, 1);
      examples::expect_valid(mesh);
      const double sum_after = inverse_ratios(mesh), least_after = worst(mesh);
      EXPECT_LE(sum_after, sum);
      EXPECT_GE(least_after, least);
      sum = sum_after, least = least_after;
    }
    EXPECT_GT(moves, 20);
  }
}

TEST(BorderSmoothing, MovesVerticesThatPiecesShareAndNoOthers) {
  const auto world = Communicator::world();
  DistributedMesh mesh = shaken(world, 11);
  const std::vector<Piece> before = mesh.pieces;
  const std::int64_t moves = relax(mesh, 1);
  std::int64_t moved = 0;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const Piece& piece = mesh.pieces[p];
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (piece.point(v) == before[p].point(v)) continue;
      ++moved;
      EXPECT_EQ(piece.vertex_dimension[v], mesh::CadDimension::region);
      EXPECT_TRUE(std::find(piece.shared_vertices.begin(), piece.shared_vertices.end(), v) !=
                  piece.shared_vertices.end());
    }
  }
  // Each is known to two pieces at least, and moves in one of the groups.
  EXPECT_GE(world.sum(moved), 2 * moves);
  EXPECT_GT(moves, 0);
}

TEST(BorderSmoothing, DoesNotDependOnRanks) {
  NEEDS_SEVERAL_RANKS();
  const auto world = Communicator::world(), self = Communicator::self();
  for (std::uint32_t seed = 20; seed < 25; ++seed) {
    DistributedMesh together = shaken(world, seed), alone = shaken(self, seed);
    const std::int64_t moves = relax(together, 2);
    EXPECT_EQ(relax(alone, 2), moves);
    EXPECT_EQ(hash(together), hash(alone));
  }
}

TEST(BorderSmoothingLocal, LeavesASinglePieceAlone) {
  const auto self = Communicator::self();
  DistributedMesh mesh = mesh::examples::distribute(self, examples::shaken_cube(5, 1, 0, 3), 1);
  EXPECT_EQ(relax(mesh, 2), 0);
}

TEST(PerturbationLocal, MovesVerticesInsideALittleAndInvertsNothing) {
  const auto self = Communicator::self();
  DistributedMesh mesh = mesh::examples::distribute(self, examples::shaken_cube(5, 1, 25, 4), 1);
  Piece& piece = mesh.pieces.front();
  piece.shared_vertices = {piece.vertex_count() - 1};
  const Piece before = piece;
  perturb(piece, 0.3, 1);
  piece.shared_vertices.clear();
  examples::expect_valid(mesh);
  int moved = 0, inside = 0;
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
    const bool free =
        piece.vertex_dimension[v] == mesh::CadDimension::region && v != piece.vertex_count() - 1;
    inside += free;
    moved += piece.point(v) != before.point(v);
    if (!free) {
      EXPECT_EQ(piece.point(v), before.point(v));
    }
    EXPECT_LT(distance(piece.point(v), before.point(v)), 0.3 * 0.2 * std::sqrt(3.0) * std::sqrt(3.0));
  }
  EXPECT_GT(moved, inside / 4);
  Piece again = before, other = before;
  perturb(again, 0.3, 1);
  perturb(other, 0.3, 2);
  EXPECT_EQ(again.coordinates, piece.coordinates);
  EXPECT_NE(other.coordinates, piece.coordinates);
}

/// A cube as a cavity that may change inside.
cavities::Cavity cavity_of(const Piece& piece) {
  cavities::Cavity cavity;
  for (LocalIndex v = 0; v < piece.vertex_count(); ++v) cavity.points.push_back(piece.point(v));
  cavity.dimension.assign(piece.vertex_dimension.begin(), piece.vertex_dimension.end());
  cavity.entity.assign(piece.vertex_entity.begin(), piece.vertex_entity.end());
  for (LocalIndex t = 0; t < piece.cell_count(); ++t) {
    const LocalIndex* c = piece.cell(t);
    cavity.tets.push_back({c[0], c[1], c[2], c[3]});
  }
  return cavity;
}

TEST(CavityImproverLocal, TakesTheBestOfSeveralTrials) {
  const auto self = Communicator::self();
  ImproveOptions options;
  options.sweeps = 3;
  const MeshSource nowhere;
  int better = 0;
  for (std::uint32_t seed = 40; seed < 50; ++seed) {
    const DistributedMesh mesh = mesh::examples::distribute(self, examples::shaken_cube(4, 1, 25, seed), 1);
    CavityImprover improver(mesh, options, nowhere);
    const cavities::Cavity cavity = cavity_of(mesh.pieces.front());
    const auto worst_of = [&](int trials) {
      ImproveReport report;
      const auto content = improver.improve_by_trials(cavity, trials, 7, report);
      double least = 1;
      const auto point = [&](LocalIndex v) {
        const auto known = static_cast<LocalIndex>(cavity.points.size());
        return v < known ? cavity.points[v] : content->added[v - known].point;
      };
      const auto& tets = content ? content->tets : cavity.tets;
      for (const auto& t : tets)
        least = std::min(least, measure(point(t[0]), point(t[1]), point(t[2]), point(t[3])));
      return least;
    };
    const double before = worst(mesh), once = worst_of(1), often = worst_of(8);
    EXPECT_GE(once, before);
    EXPECT_GE(often, once);
    EXPECT_EQ(worst_of(8), often);
    better += often > once;
  }
  EXPECT_GT(better, 0);
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
    cavities::CavityClaims claims;
    for (int shift = 0; shift < 4; ++shift) {
      if (world.sum(claim_for_bad(mesh, bad, measure, shift, Effort::reduced, claims)) == 0) break;
      bad.update(mesh, cavities::replace_cavities(mesh, mesh::SharedVertices(mesh), {claims, {}, improve}));
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
