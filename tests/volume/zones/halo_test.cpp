/// What zones know of the space around them, against the rule taken literally.
#include "volume/zones/halo.hpp"

#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"
#include "volume/lattice/grid_box_tree.hpp"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using parallel::Communicator;

/// A block and those of its leaves that a zone knows, a bit each.
struct TakenBlock {
  BlockIndex block;
  std::uint8_t leaves;
};

/// A lattice with a surface in it, divided into zones.
struct Divided {
  Divided(const sizing::SizeField& field, const surfaces::Surface& surface, ZoneIndex count)
      : problem(Communicator::self(), surface, field),
        lattice(problem, box_of(surface)),
        zones(divide(lattice.tree, count)) {}

  static Zones divide(const LatticeTree& tree, ZoneIndex count) {
    std::vector<Load> loads(tree.block_count());
    for (BlockIndex b = 0; b < tree.block_count(); ++b) loads[b] = tree.leaf_count(b);
    return cut_into_zones(tree, loads, count);
  }

  std::vector<TakenBlock> take(ZoneIndex zone, double width) const {
    const LatticeTree& tree = lattice.tree;
    const std::vector<double> widths(zones.count(), width);
    ZonesAround around(lattice, zones, widths);
    std::vector<TakenBlock> taken;
    for (BlockIndex b = 0; b < tree.block_count(); ++b) {
      around.move_to(b);
      for (const HaloZone& halo : around.zones()) {
        std::uint8_t leaves = 0;
        for (int child = 0; halo.zone == zone && child < tree.leaf_count(b); ++child) {
          if (halo.reaches(GridBox::of(tree.leaf(b, child))))
            leaves |= static_cast<std::uint8_t>(1U << child);
        }
        if (leaves != 0) taken.push_back({b, leaves});
      }
    }
    return taken;
  }

  void reassign(BlockIndex b, int child, ZoneIndex to) {
    zones.reassign({lattice.tree.number(b), child, GridBox::of(lattice.tree.leaf(b, child)), to});
  }

  /// The largest size in a block and those it touches.
  double size_around(BlockIndex b) const {
    const LatticeTree& tree = lattice.tree;
    double size = 0;
    for (BlockIndex n = 0; n < tree.block_count(); ++n) {
      if (!GridBox::of(tree.cube(n)).overlaps(GridBox::of(tree.cube(b)))) continue;
      size = std::max({size, mean_edge_of_cell * lattice.frame.edge(tree.leaf_level(n)),
                       double{lattice.table.longest_edge[n]}});
    }
    return size;
  }

  /// By block: the leaves that are the zone's or near enough.
  std::vector<TakenBlock> expected(ZoneIndex zone, double width) const {
    const LatticeTree& tree = lattice.tree;
    const std::vector<LeafOfBlock> leaves = all_leaves(tree);
    std::vector<GridBox> own;
    for (const LeafOfBlock& leaf : leaves) {
      if (zones.of(leaf.block, leaf.child) == zone) own.push_back(GridBox::of(leaf.cell));
    }
    std::vector<std::uint8_t> taken(tree.block_count(), 0);
    for (BlockIndex b = 0; b < tree.block_count(); ++b) {
      const double radius = lattice.frame.grid_distance(width * sizes[b]);
      for (int child = 0; child < tree.leaf_count(b); ++child) {
        const GridBox box = GridBox::of(tree.leaf(b, child));
        if (std::any_of(own.begin(), own.end(), [&](const GridBox& o) { return o.gap_to(box) <= radius; }))
          taken[b] |= static_cast<std::uint8_t>(1U << child);
      }
    }
    std::vector<TakenBlock> result;
    for (BlockIndex b = 0; b < tree.block_count(); ++b) {
      if (taken[b]) result.push_back({b, taken[b]});
    }
    return result;
  }
  void measure_sizes() {
    for (BlockIndex b = 0; b < lattice.tree.block_count(); ++b) sizes.push_back(size_around(b));
  }

  Problem problem;
  GrownLattice lattice;
  Zones zones;
  std::vector<double> sizes;  // per block
};

void expect_same(const std::vector<TakenBlock>& found, const std::vector<TakenBlock>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].block, expected[i].block);
    EXPECT_EQ(int{found[i].leaves}, int{expected[i].leaves}) << "block " << found[i].block;
  }
}

void expect_rule(Divided& divided, const std::vector<double>& widths) {
  divided.measure_sizes();
  std::size_t taken = 0, own = 0;
  for (ZoneIndex z = 0; z < divided.zones.count(); ++z) {
    for (const double width : widths) {
      const auto expected = divided.expected(z, width);
      expect_same(divided.take(z, width), expected);
      taken += expected.size();
      for (BlockIndex b = 0; b < divided.lattice.tree.block_count(); ++b) own += divided.zones.has(z, b);
    }
  }
  EXPECT_GT(taken, own);
}

TEST(Halo, is_what_the_rule_says_in_a_uniform_lattice) {
  Divided divided(fields::uniform(0.2), surfaces::cube({0, 0, 0}, 1.9, 14), 5);
  expect_rule(divided, {0.6, 1.5, 2.5});
}

TEST(Halo, is_what_the_rule_says_where_sizes_change) {
  Divided divided(fields::around_unit_sphere(0.12, 0.8), surfaces::cube_with_ball(5, 9), 4);
  expect_rule(divided, {1.0, 1.5, 2.25});
}

TEST(Halo, is_what_the_rule_says_where_sizes_jump) {
  const std::vector<sizing::SizeSource> sources{{{0.3, 0.2, -0.4}, 0.02}, {{-1.2, 1, 1}, 0.03}};
  Divided divided(sizing::SizeField::build(fields::domain, sources, {0.02, 0.9, 12, 1.6}),
                  surfaces::cube({0, 0, 0}, 1.9, 5), 4);
  expect_rule(divided, {1.5});
}

/// Triangles much longer than the lattice beside them.
TEST(Halo, is_what_the_rule_says_beside_long_triangles) {
  surfaces::Surface surface = surfaces::cube({0, 0, 0}, 1.9, 14);
  surfaces::append(surface, surfaces::box({-1.5, -0.1, -0.1}, {1.5, 0.1, 0.1}, {2, 1, 1}),
                   surfaces::Turn::inward);
  Divided divided(fields::uniform(0.2), surface, 5);
  expect_rule(divided, {1.5});
}

TEST(Halo, is_what_the_rule_says_around_reassigned_leaves) {
  Divided divided(fields::around_unit_sphere(0.12, 0.8), surfaces::cube_with_ball(5, 9), 4);
  std::mt19937_64 random(2);
  const LatticeTree& tree = divided.lattice.tree;
  for (int i = 0; i < 40; ++i) {
    const auto b = static_cast<BlockIndex>(random() % tree.block_count());
    const int child = static_cast<int>(random() % tree.leaf_count(b));
    divided.reassign(b, child, static_cast<ZoneIndex>(random() % 4));
  }
  expect_rule(divided, {1.5});
  divided.zones.merge(3, 1);
  EXPECT_TRUE(divided.take(3, 1.5).empty());
  expect_same(divided.take(1, 1.5), divided.expected(1, 1.5));
}

TEST(Halo, holds_all_leaves_of_the_zone_itself) {
  Divided divided(fields::uniform(0.25), surfaces::cube({0, 0, 0}, 1.9, 10), 6);
  divided.reassign(divided.lattice.tree.block_count() / 2, 0, 5);
  for (ZoneIndex z = 0; z < 6; ++z) {
    const std::vector<TakenBlock> taken = divided.take(z, 0);
    for (const LeafOfBlock& leaf : all_leaves(divided.lattice.tree)) {
      if (divided.zones.of(leaf.block, leaf.child) != z) continue;
      const auto at = std::lower_bound(taken.begin(), taken.end(), leaf.block,
                                       [](const TakenBlock& t, BlockIndex b) { return t.block < b; });
      ASSERT_TRUE(at != taken.end() && at->block == leaf.block);
      EXPECT_TRUE(at->leaves >> leaf.child & 1);
    }
  }
}

TEST(Halo, of_one_zone_is_all_there_is) {
  const Divided divided(fields::uniform(0.25), surfaces::cube({0, 0, 0}, 1.9, 10), 1);
  const std::vector<TakenBlock> all = divided.take(0, 1.5);
  ASSERT_EQ(static_cast<BlockIndex>(all.size()), divided.lattice.tree.block_count());
  for (const TakenBlock& taken : all) EXPECT_EQ(taken.leaves, divided.lattice.tree.all_leaves(taken.block));
}

TEST(LargestSizeAround, looks_at_a_block_and_those_it_touches) {
  surfaces::Surface surface = surfaces::cube_with_ball(3, 9);
  const Divided divided(fields::around_unit_sphere(0.12, 0.8), surface, 2);
  for (BlockIndex b = 0; b < divided.lattice.tree.block_count(); b += 3) {
    EXPECT_EQ(largest_size_around(divided.lattice, b), divided.size_around(b));
  }
}

TEST(GridBoxTree, tell_whether_one_is_near) {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> place(0, 100);
  const auto box = [&] {
    const Vec3 low{place(random), place(random), place(random)};
    return GridBox{low, low + Vec3{3, 1, 2}};
  };
  for (const int count : {0, 1, 2, 3, 7, 40}) {
    GridBoxTree near;
    std::vector<GridBox> boxes;
    for (int i = 0; i < count; ++i) {
      boxes.push_back(box());
      near.add(boxes.back());
    }
    near.build();
    for (int i = 0; i < 200; ++i) {
      const GridBox asked = box();
      const double radius = 0.3 * place(random);
      const bool expected = std::any_of(boxes.begin(), boxes.end(),
                                        [&](const GridBox& b) { return b.gap_to(asked) <= radius; });
      EXPECT_EQ(near.any_within(asked, radius), expected);
    }
  }
}

}  // namespace
}  // namespace aeroloom::volume
