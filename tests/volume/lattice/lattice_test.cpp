/// The octree of the interior points.
#include "mesh/data/mixing.hpp"
#include "tests/several_ranks.hpp"
#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Box;
using geometry::Vec3;
using parallel::Communicator;

constexpr double root_size = sizing::grid_size;

sizing::SizeField graded() {
  return fields::around_unit_sphere(0.06, 0.5);
}

/// A field so steep that the size at a cell's centre tells little of that in its corners.
std::vector<sizing::SizeSource> few_sources() {
  Random random;
  std::vector<sizing::SizeSource> sources;
  for (int i = 0; i < 60; ++i) sources.push_back({random.in(fields::domain), random.between(0.01, 0.02)});
  return sources;
}
sizing::SizeField steep() {
  return sizing::SizeField::build(fields::domain, few_sources(), {0.01, 1.0, 12, 2.5});
}

struct Grown {
  explicit Grown(sizing::SizeField sizes, const Communicator& communicator = Communicator::self(),
                 const Box& box = fields::domain)
      : field(std::move(sizes)), frame(field, box), wanted(box), tree(communicator, frame, field, wanted) {}

  /// Whether sizes ask for a cell to be split.
  bool is_too_coarse(const GridCube& cell) const {
    if (!frame.box_around(cell).overlaps(wanted)) return false;
    const double half = 0.5 * cell.edge();
    const double size = field(frame.to_space(GridBox::of(cell).low + Vec3{half, half, half}));
    return mean_edge_of_cell * frame.edge(cell.level) > LatticeTree::coarsest_edge * size;
  }

  sizing::SizeField field;
  LatticeFrame frame;
  Box wanted;
  LatticeTree tree;
};

TEST(LatticeTreeLocal, fills_the_root_along_the_curve) {
  for (const Grown& grown : {Grown(graded()), Grown(steep())}) {
    std::uint64_t next = 0;
    for (BlockIndex b = 0; b < grown.tree.block_count(); ++b) {
      const GridCube cell = grown.tree.cube(b);
      EXPECT_EQ(sizing::morton_key(cell.low), next);
      next += std::uint64_t{cell.edge()} * cell.edge() * cell.edge();
      double volume = 0;
      for (int child = 0; child < grown.tree.leaf_count(b); ++child) {
        const GridCube leaf = grown.tree.leaf(b, child);
        EXPECT_EQ(leaf.level, grown.tree.leaf_level(b));
        volume += std::pow(leaf.edge(), 3);
      }
      EXPECT_EQ(volume, std::pow(cell.edge(), 3));
      EXPECT_EQ(grown.tree.all_leaves(b), grown.tree.leaf_count(b) == 8 ? 0xff : 1);
    }
    EXPECT_EQ(next, std::uint64_t{1} << 3 * sizing::finest_level);
  }
}

TEST(LatticeTreeLocal, keeps_neighbours_within_one_level) {
  for (const Grown& grown : {Grown(fields::around_unit_sphere(0.12, 0.9)), Grown(steep())}) {
    std::vector<LeafOfBlock> leaves = all_leaves(grown.tree);
    std::sort(leaves.begin(), leaves.end(),
              [](const LeafOfBlock& a, const LeafOfBlock& b) { return a.cell.low.x < b.cell.low.x; });
    int most = 0;
    std::int64_t pairs = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const GridBox box = GridBox::of(leaves[i].cell);
      for (std::size_t j = i + 1; j < leaves.size() && leaves[j].cell.low.x <= box.high.x; ++j) {
        if (!box.overlaps(GridBox::of(leaves[j].cell))) continue;
        most = std::max(most, std::abs(leaves[i].cell.level - leaves[j].cell.level));
        ++pairs;
      }
    }
    EXPECT_EQ(most, 1);
    EXPECT_GT(pairs, 1000);
  }
}

void expect_no_split_without_need(const Grown& grown) {
  const LatticeTree& tree = grown.tree;
  const std::vector<LeafOfBlock> leaves = all_leaves(tree);
  int split = 0;
  for (const LeafOfBlock& leaf : leaves) EXPECT_FALSE(grown.is_too_coarse(leaf.cell));
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    if (tree.leaf_count(b) != 8 || grown.is_too_coarse(tree.cube(b))) continue;
    ++split;
    const GridBox box = GridBox::of(tree.cube(b));
    EXPECT_TRUE(std::any_of(leaves.begin(), leaves.end(),
                            [&](const LeafOfBlock& leaf) {
                              return leaf.cell.level >= tree.cube(b).level + 2 &&
                                     GridBox::of(leaf.cell).overlaps(box);
                            }))
        << "block " << b << " is split without need";
  }
  EXPECT_GT(split, 10);
}

TEST(LatticeTreeLocal, splits_what_sizes_ask_for_and_balance_needs) {
  expect_no_split_without_need(Grown(graded()));
}

/// Half a model: sizes are as small on the other side, which the sheared cubes reach.
TEST(LatticeTreeLocal, does_not_split_what_lies_off_the_box) {
  Box half = fields::domain;
  half.low.y = half.center().y;
  expect_no_split_without_need(Grown(graded(), Communicator::self(), half));
}

TEST(LatticeTreeLocal, is_no_finer_than_the_sizes_off_the_box) {
  const Grown grown(fields::uniform(0.1), Communicator::self(), {{1, 1, 1}, {1.5, 1.5, 1.5}});
  int inside = 0;
  for (const LeafOfBlock& leaf : all_leaves(grown.tree)) {
    const double ratio = mean_edge_of_cell * grown.frame.edge(leaf.cell.level) / 0.1;
    if (grown.frame.box_around(leaf.cell).overlaps(grown.wanted)) {
      EXPECT_NEAR(ratio, 1, 1e-9);
      ++inside;
    } else {
      EXPECT_GT(ratio, 0.99);
    }
  }
  EXPECT_GT(inside, 100);
  EXPECT_LT(grown.tree.leaf_level(0), 3);
}

TEST(LatticeTreeLocal, misses_no_small_size_in_a_steep_field) {
  const Grown grown(steep());
  int fine = 0;
  for (const sizing::SizeSource& source : few_sources()) {
    const sizing::GridPoint p = grown.frame.cell_at(grown.frame.to_grid(source.point));
    const BlockIndex b = grown.tree.block_at(p);
    for (int level = grown.tree.leaf_level(b); level < sizing::finest_level; ++level) {
      const std::uint32_t mask = ~((sizing::grid_size >> level) - 1);
      EXPECT_FALSE(grown.is_too_coarse({{p.x & mask, p.y & mask, p.z & mask}, level}));
    }
    fine += mean_edge_of_cell * grown.frame.edge(grown.tree.leaf_level(b)) < 2.5 * source.size;
  }
  EXPECT_GT(fine, 40);
}

TEST(LatticeTree, is_the_same_on_any_number_of_ranks) {
  NEEDS_SEVERAL_RANKS();
  const Communicator world = Communicator::world();
  // Several thousand cells of one level are needed for the ranks to have anything to share out.
  for (const auto& field : {fields::uniform(0.08), fields::around_unit_sphere(0.04, 0.4), steep()}) {
    const Grown shared(field, world), alone(field);
    ASSERT_EQ(shared.tree.total(), alone.tree.block_count());
    EXPECT_EQ(world.sum(std::int64_t{shared.tree.last() - shared.tree.first()}), shared.tree.total());
    for (BlockIndex b = shared.tree.first(); b < shared.tree.last(); ++b) {
      const auto same = static_cast<BlockIndex>(shared.tree.number(b));
      ASSERT_EQ(shared.tree.index(same), b);
      ASSERT_EQ(shared.tree.owner(same), world.rank());
      ASSERT_EQ(shared.tree.cube(b), alone.tree.cube(same));
      ASSERT_EQ(shared.tree.leaf_count(b), alone.tree.leaf_count(same));
    }
  }
}

/// A rank with every third block as a ghost, as of a tree that is all there.
TEST(LatticeTree, adds_blocks_of_other_ranks) {
  const Communicator world = Communicator::world();
  const Grown alone(graded());
  Grown shared(graded(), world);
  LatticeTree& tree = shared.tree;
  std::vector<PackedBlock> some;
  for (BlockIndex b = 0; b < alone.tree.block_count(); b += 3) some.push_back(alone.tree.packed(b));
  tree.add(some);
  std::int64_t at = 0;
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    const GridCube cube = tree.cube(b);
    EXPECT_EQ(static_cast<std::int64_t>(cube.key()), at);
    at += std::int64_t{1} << 3 * (sizing::finest_level - cube.level);
    EXPECT_EQ(tree.any_at(cube.low), b);
    if (!tree.is_local(b)) {
      EXPECT_THROW(static_cast<void>(tree.block_at(cube.low)), std::logic_error);
      EXPECT_THROW(tree.for_each_block_in(GridBox::of(cube), [](BlockIndex) {}), std::logic_error);
      continue;
    }
    const BlockNumber number = tree.number(b);
    EXPECT_EQ(alone.tree.cube(static_cast<BlockIndex>(number)), cube);
    EXPECT_EQ(tree.index(number), b);
    EXPECT_EQ(tree.is_own(b), tree.owner(number) == world.rank());
    EXPECT_TRUE(tree.is_own(b) || number % 3 == 0);
  }
  EXPECT_EQ(at, std::int64_t{1} << 3 * sizing::finest_level);
  for (BlockNumber n = 0; n < tree.total(); ++n)
    EXPECT_EQ(tree.has(n), n % 3 == 0 || tree.owner(n) == world.rank());
  // Who has what is near a block.
  for (BlockIndex b = 0; b < alone.tree.block_count(); b += 50) {
    const GridBox box = GridBox::of(alone.tree.cube(b)).dilated(0.5);
    std::set<parallel::Rank> expected, found;
    alone.tree.for_each_block_in(box, [&](BlockIndex n) { expected.insert(tree.owner(n)); });
    tree.for_each_rank_in(box, [&](parallel::Rank rank) { found.insert(rank); });
    EXPECT_EQ(found, expected);
  }
}

TEST(LatticeTreeLocal, finds_blocks_and_leaves_of_places) {
  Random random;
  const Grown grown(graded());
  const std::vector<LeafOfBlock> leaves = all_leaves(grown.tree);
  for (int i = 0; i < 300; ++i) {
    const sizing::GridPoint p{static_cast<std::uint32_t>(random.between(0, root_size)),
                              static_cast<std::uint32_t>(random.between(0, root_size)),
                              static_cast<std::uint32_t>(random.between(0, root_size))};
    const BlockIndex b = grown.tree.block_at(p);
    const int child = grown.tree.child_at(b, p);
    int holders = 0;
    for (const LeafOfBlock& leaf : leaves) {
      const auto within = [&](std::uint32_t low, std::uint32_t x) {
        return low <= x && x < low + leaf.cell.edge();
      };
      if (!within(leaf.cell.low.x, p.x) || !within(leaf.cell.low.y, p.y) || !within(leaf.cell.low.z, p.z))
        continue;
      ++holders;
      EXPECT_EQ(leaf.block, b);
      EXPECT_EQ(leaf.child, child);
    }
    EXPECT_EQ(holders, 1);
  }
}

TEST(LatticeTreeLocal, knows_which_cells_are_split) {
  const Grown grown(graded());
  for (const LeafOfBlock& leaf : all_leaves(grown.tree)) {
    EXPECT_FALSE(grown.tree.is_split(leaf.cell));
    for (int level = 0; level < leaf.cell.level; ++level) {
      const std::uint32_t mask = ~((sizing::grid_size >> level) - 1);
      const GridCube above{{leaf.cell.low.x & mask, leaf.cell.low.y & mask, leaf.cell.low.z & mask}, level};
      EXPECT_TRUE(grown.tree.is_split(above));
    }
    EXPECT_FALSE(grown.tree.is_split({leaf.cell.low, leaf.cell.level + 1}));
  }
}

TEST(LatticeTreeLocal, visits_the_blocks_in_a_box) {
  Random random;
  const Grown grown(graded());
  std::size_t visited = 0;
  for (int i = 0; i < 400; ++i) {
    const double size = root_size * std::exp2(-random.between(0, 14));
    const Vec3 low{random.between(-size, root_size), random.between(-size, root_size),
                   random.between(-size, root_size)};
    const GridBox box{low, low + Vec3{size * random.between(0, 1), size * random.between(0, 1), size}};
    if (box.high.x < 0 || box.high.y < 0 || box.high.z < 0) continue;
    std::vector<BlockIndex> expected, found;
    for (BlockIndex b = 0; b < grown.tree.block_count(); ++b) {
      if (GridBox::of(grown.tree.cube(b)).overlaps(box)) expected.push_back(b);
    }
    grown.tree.for_each_block_in(box, [&](BlockIndex b) { found.push_back(b); });
    EXPECT_EQ(found, expected);
    visited += found.size();
    int asked = 0;
    const bool any =
        grown.tree.any_block_in(box, [&](BlockIndex b) { return ++asked, b == expected.back(); });
    EXPECT_TRUE(any);
    EXPECT_EQ(asked, static_cast<int>(expected.size()));
    asked = 0;
    EXPECT_TRUE(grown.tree.any_block_in(box, [&](BlockIndex) { return ++asked > 0; }));
    EXPECT_EQ(asked, 1);
    EXPECT_FALSE(grown.tree.any_block_in(box, [](BlockIndex) { return false; }));
  }
  EXPECT_GT(visited, 1000u);
}

/// Halos look for what is half a cell away from a block: neighbours over faces, edges and corners.
TEST(LatticeTreeLocal, visits_the_neighbours_of_a_block) {
  const Grown grown(fields::around_unit_sphere(0.15, 0.9));
  const LatticeTree& tree = grown.tree;
  for (BlockIndex b = 0; b < tree.block_count(); b += 7) {
    const GridBox box = GridBox::of(tree.cube(b));
    std::vector<BlockIndex> expected, found;
    for (BlockIndex n = 0; n < tree.block_count(); ++n) {
      if (GridBox::of(tree.cube(n)).overlaps(box)) expected.push_back(n);
    }
    tree.for_each_block_in(box.dilated(0.5), [&](BlockIndex n) { found.push_back(n); });
    EXPECT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace aeroloom::volume
