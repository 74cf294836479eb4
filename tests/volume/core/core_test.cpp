/// Core and shell: what comes from the table fits what TetGen makes of the rest.
#include "tests/volume/fields.hpp"
#include "tests/volume/filled.hpp"

#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using parallel::Communicator;

// --- the squares

/// The area that triangles cover, in quarters of the square.
int covered(const std::span<const CoreSquares::Triangle>& triangles) {
  int twice = 0;
  for (const auto& [a, b, c] : triangles) {
    const auto &p = square_places[a], &q = square_places[b], &r = square_places[c];
    twice += (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  }
  return twice / 2;
}

TEST(SquaresLocal, are_covered_whatever_points_stand_on_their_edges) {
  const sizing::SizeField field = fields::uniform(0.3);
  const LatticeFrame frame(field, {{-1, -1, -1}, {1, 1, 1}});
  const CoreSquares squares(frame);
  for (int axis = 0; axis < 3; ++axis) {
    for (SquarePattern pattern = 0; pattern < square_patterns; ++pattern) {
      const auto triangles = squares.triangles(axis, pattern);
      EXPECT_EQ(triangles.size(), 2u + static_cast<unsigned>(__builtin_popcount(pattern)));
      EXPECT_EQ(covered(triangles), 4);
    }
  }
}

// --- cores of any shape

/// The shell of the same lattice once blocks have changed.
LocalShell remade(const Lattice& lattice, std::vector<BlockChange> changes) {
  return make_local_shell(lattice, gather_local_surface(lattice), std::move(changes));
}

/// Leaves and blocks leave the core by chance: it has holes and stairs, and is one leaf thick in places.
void make_ragged(const Problem& problem, Decomposition::Data& data, int seed) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  const auto chance = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
  const double of_leaf = 0.6 * chance(), of_block = 0.3 * chance();
  const Lattice& lattice = *data.lattice;
  std::vector<BlockChange> changes(lattice.tree.block_count());
  for (BlockNumber number = 0; number < lattice.tree.total(); ++number) {
    std::uint8_t shell = 0;
    for (int child = 0; child < 8; ++child) {
      if (chance() < of_leaf) shell |= static_cast<std::uint8_t>(1U << child);
    }
    if (chance() < of_block) shell = 0xff;
    if (lattice.tree.has(number)) changes[lattice.tree.index(number)].shell = shell;
  }
  data.shell.local = remade(lattice, std::move(changes));
  EXPECT_LT(problem.communicator.sum(data.shell.local.core_cells()), data.report.core_tetrahedra);
  std::vector<ZoneIndex> all(data.shell.zones.count());
  std::iota(all.begin(), all.end(), 0);
  data.plan = plan_zones(lattice, data.shell, all, std::vector(all.size(), problem.options.halo));
}

VolumeOptions in_zones_of(std::int64_t tets) {
  VolumeOptions options;
  options.piece_tets = tets;
  return options;
}

class RaggedCore : public testing::TestWithParam<int> {};
class RaggedCoreLocal : public RaggedCore {};

/// Every triangle of the border is a face of the shell's mesh, through zones with halos.
void expect_border_in_shell(int seed) {
  const Communicator world = Communicator::world();
  const surfaces::Surface surface = seed % 2 == 0 ? surfaces::shaken(surfaces::cube_with_ball(10, 9), 0.03)
                                                  : surfaces::shaken(surfaces::nested_cubes(8), 0.03);
  const sizing::SizeField field =
      seed % 2 == 0 ? fields::around_unit_sphere(0.1, 0.5) : fields::around_unit_sphere(0.08, 0.3);
  const Filled ragged(
      world, surface, field, in_zones_of(seed % 3 == 0 ? 100'000'000 : 2500),
      [&](const Problem& problem, Decomposition::Data& data) { make_ragged(problem, data, seed); });
  EXPECT_GT(ragged.report.core_tetrahedra, ragged.report.tetrahedra / 20);
  EXPECT_EQ(ragged.report.left_core, 0);
  EXPECT_TRUE(ragged.report.retries.empty());
  EXPECT_TRUE(ragged.report.disagreements.empty());
  expect_valid(ragged, surface);
}

TEST_P(RaggedCore, has_its_border_in_the_mesh_of_the_shell) {
  expect_border_in_shell(GetParam());
}
TEST_P(RaggedCoreLocal, has_its_border_in_the_mesh_of_the_shell) {
  expect_border_in_shell(GetParam());
}

INSTANTIATE_TEST_SUITE_P(seeds, RaggedCore, testing::Range(1, 4));
INSTANTIATE_TEST_SUITE_P(seeds, RaggedCoreLocal, testing::Range(4, 8));

// --- leaves that leave

TEST(Core, gives_leaves_to_the_shell_that_may_not_stay) {
  const Communicator world = Communicator::world();
  const surfaces::Surface surface = surfaces::shaken(surfaces::cube_with_ball(10, 9), 0.03);
  const Problem problem(world, surface, fields::around_unit_sphere(0.1, 0.5));
  Decomposition decomposition = decompose(problem.input());
  const Decomposition::Data& data = decomposition.data();
  const LatticeTree& tree = data.lattice->tree;
  const CoreLeaves& core = data.shell.local.core;
  // A block that is all core.
  std::int64_t chosen = INT64_MAX;
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    if (core.of(b) == 0xff) chosen = std::min(chosen, tree.number(b));
  }
  chosen = world.minimum(chosen);
  ASSERT_LT(chosen, tree.total());
  std::vector<BlockChange> changes = data.shell.local.changes;
  if (tree.has(chosen)) changes[tree.index(chosen)].shell = 0xff;
  const LocalShell after = remade(*data.lattice, std::move(changes));
  EXPECT_GT(world.sum(static_cast<std::int64_t>(after.points.points.size())), data.report.shell_points);
  if (tree.owner(chosen) == world.rank()) {
    const std::vector<BlockIndex> changed = after.core.blocks_unlike(core);
    const BlockIndex block = tree.index(chosen);
    EXPECT_NE(std::find(changed.begin(), changed.end(), block), changed.end());
    EXPECT_EQ(after.core.of(block), 0);
  }
}

}  // namespace
}  // namespace aeroloom::volume
