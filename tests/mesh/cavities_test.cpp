#include "mesh/cavities.hpp"

#include "mesh/validity.hpp"
#include "tests/mesh/meshes.hpp"

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;

constexpr int squares = 6, pieces = 7;

/// Every shared vertex inside wishes for the cavity of its cell.
CavityWishes wish_for_shared(const DistributedMesh& mesh, int shift) {
  CavityWishes wishes;
  for (const Piece& piece : mesh.pieces) {
    auto& mine = wishes.emplace_back(piece.vertex_count(), no_cavity);
    for (const LocalIndex v : piece.shared_vertices) {
      if (piece.vertex_dimension[v] == 3) mine[v] = cavity_at(piece.point(v), 0.3, 1, shift);
    }
  }
  return wishes;
}

/// The tetrahedra as they were.
std::optional<Refilling> same(const Cavity& cavity) {
  return Refilling{{}, cavity.tets};
}

/// Each tetrahedron divided in four by a vertex in its middle.
std::optional<Refilling> divided(const Cavity& cavity) {
  Refilling result;
  auto next = static_cast<LocalIndex>(cavity.points.size());
  for (const auto& tet : cavity.tets) {
    geometry::Vec3 middle;
    for (const LocalIndex v : tet) middle += 0.25 * cavity.points[v];
    result.added.push_back(middle);
    for (int k = 0; k < 4; ++k) {
      auto part = tet;
      part[k] = next;
      result.tets.push_back(part);
    }
    ++next;
  }
  return result;
}

GlobalIndex count_cells(const Communicator& communicator, const DistributedMesh& mesh) {
  return number_mesh(communicator, mesh).cell_count;
}

void expect_valid(const Communicator& communicator, const DistributedMesh& mesh) {
  const Numbering numbering = number_mesh(communicator, mesh);
  const ValidityReport report = check_volume_mesh(communicator, mesh, numbering, nullptr);
  EXPECT_TRUE(report.valid()) << (report.violations.empty() ? "" : report.violations.front());
  EXPECT_NEAR(report.volume, 1, 1e-12);
}

std::string hash(const Communicator& communicator, const DistributedMesh& mesh) {
  return hash_mesh(communicator, mesh, number_mesh(communicator, mesh));
}

TEST(Cavities, KeepTheMeshWhole) {
  const auto world = Communicator::world();
  DistributedMesh mesh = examples::cube(world, squares, pieces);
  const GlobalIndex cells = count_cells(world, mesh);
  parallel::StageClock clock;
  for (int shift = 0; shift < 4; ++shift) {
    const CavityRound round = refill_cavities(world, mesh, wish_for_shared(mesh, shift), same, clock);
    EXPECT_GT(round.cavities, 0);
    EXPECT_EQ(round.refilled, round.cavities);
    expect_valid(world, mesh);
    EXPECT_EQ(count_cells(world, mesh), cells);
  }
}

TEST(Cavities, TakeNewVertices) {
  const auto world = Communicator::world();
  DistributedMesh mesh = examples::cube(world, squares, pieces);
  const GlobalIndex cells = count_cells(world, mesh);
  parallel::StageClock clock;
  std::int64_t taken = 0;
  refill_cavities(
      world, mesh, wish_for_shared(mesh, 0),
      [&](const Cavity& cavity) {
        taken += static_cast<std::int64_t>(cavity.tets.size());
        return divided(cavity);
      },
      clock);
  expect_valid(world, mesh);
  EXPECT_EQ(count_cells(world, mesh), cells + 3 * world.sum(taken));
}

TEST(Cavities, AreTheSameForAnyNumberOfRanks) {
  const auto world = Communicator::world(), self = Communicator::self();
  DistributedMesh together = examples::cube(world, squares, pieces);
  DistributedMesh alone = examples::cube(self, squares, pieces);
  parallel::StageClock clock;
  for (int shift = 0; shift < 3; ++shift) {
    const auto refill = shift == 1 ? divided : same;
    refill_cavities(world, together, wish_for_shared(together, shift), refill, clock);
    refill_cavities(self, alone, wish_for_shared(alone, shift), refill, clock);
  }
  EXPECT_EQ(hash(world, together), hash(self, alone));
}

TEST(Cavities, ThatAreNotRefilledStay) {
  const auto world = Communicator::world();
  DistributedMesh mesh = examples::cube(world, squares, pieces);
  const std::string before = hash(world, mesh);
  parallel::StageClock clock;
  const CavityRound round = refill_cavities(
      world, mesh, wish_for_shared(mesh, 0), [](const Cavity&) { return std::nullopt; }, clock);
  EXPECT_GT(round.cavities, 0);
  EXPECT_EQ(round.refilled, 0);
  EXPECT_EQ(hash(world, mesh), before);
}

TEST(CavityAt, NamesTheSamePlaceAlike) {
  const geometry::Vec3 p{0.3, -1.7, 12.5};
  for (int shift = 0; shift < 6; ++shift) {
    EXPECT_EQ(cavity_at(p, 0.1, 8, shift), cavity_at(p + geometry::Vec3{1e-9, 0, 0}, 0.1, 8, shift));
    EXPECT_NE(cavity_at(p, 0.1, 8, shift), cavity_at(p + geometry::Vec3{100, 0, 0}, 0.1, 8, shift));
    EXPECT_NE(cavity_at(p, 0.1, 8, shift), no_cavity);
  }
}

}  // namespace
}  // namespace aeroloom::mesh
