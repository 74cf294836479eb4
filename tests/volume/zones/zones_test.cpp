/// Zones of equal load, and what becomes of their leaves.
#include "volume/zones/zones.hpp"

#include "tests/volume/fields.hpp"
#include "tests/volume/steps.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::volume {
namespace {

using geometry::Vec3;
using parallel::Communicator;

struct Tree {
  explicit Tree(const sizing::SizeField& field, const geometry::Box& box = fields::domain)
      : frame(field, box), tree(Communicator::self(), frame, field, box) {}

  /// A load for each block in the box, in proportion to its leaves, and a little chance.
  std::vector<Load> loads(const geometry::Box& box = fields::domain) const {
    std::mt19937_64 random(3);
    std::vector<Load> result(tree.block_count(), 0);
    for (BlockIndex b = 0; b < tree.block_count(); ++b) {
      const Vec3 center = center_of(b);
      if (box.contains(center)) result[b] = static_cast<Load>(50 + random() % 100) * tree.leaf_count(b);
    }
    return result;
  }
  Vec3 center_of(BlockIndex b) const {
    const GridBox box = GridBox::of(tree.cube(b));
    return frame.to_space(0.5 * (box.low + box.high));
  }

  LatticeFrame frame;
  LatticeTree tree;
};

std::vector<ZoneIndex> zone_of_each(const LatticeTree& tree, const Zones& zones) {
  std::vector<ZoneIndex> result;
  for (BlockIndex b = 0; b < tree.block_count(); ++b) result.push_back(zones.of(b, 0));
  return result;
}

TEST(ZoneCuts, makes_zones_of_equal_load) {
  const auto field = fields::around_unit_sphere(0.05, 0.4);
  const Tree lattice(field);
  const std::vector<Load> loads = lattice.loads();
  const auto total = static_cast<double>(std::accumulate(loads.begin(), loads.end(), Load{0}));
  for (const ZoneIndex count : {1, 2, 3, 5, 8, 13, 40}) {
    const Zones zones = cut_into_zones(lattice.tree, loads, count);
    EXPECT_EQ(zones.count(), count);
    std::vector<double> of_zone(count, 0);
    for (BlockIndex b = 0; b < lattice.tree.block_count(); ++b) {
      const ZoneIndex z = zones.of(b, 0);
      ASSERT_GE(z, 0);
      ASSERT_LT(z, count);
      of_zone[z] += static_cast<double>(loads[b]);
      EXPECT_TRUE(zones.is_whole(b));
      EXPECT_EQ(zones.of(b, 7), z);
    }
    for (const double load : of_zone)
      EXPECT_NEAR(load * count / total, 1, count < 20 ? 0.1 : 0.25) << count;  // a layer of blocks
  }
}

TEST(ZoneCuts, is_a_function_of_its_arguments) {
  const auto field = fields::around_unit_sphere(0.08, 0.4);
  const Tree lattice(field), again(field);
  EXPECT_EQ(zone_of_each(lattice.tree, cut_into_zones(lattice.tree, lattice.loads(), 9)),
            zone_of_each(again.tree, cut_into_zones(again.tree, again.loads(), 9)));
}

TEST(ZoneCuts, cuts_a_bar_across_its_length) {
  const auto field = fields::uniform(0.1);
  const Tree lattice(field);
  for (int axis = 0; axis < 3; ++axis) {
    geometry::Box bar{{-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}};
    bar.low[axis] = -1.9, bar.high[axis] = 1.9;
    const std::vector<Load> loads = lattice.loads(bar);
    const Zones zones = cut_into_zones(lattice.tree, loads, 4);
    // One behind the other along the bar; the lattice is sheared by three parts in a hundred.
    std::vector<double> low(4, 10), high(4, -10);
    for (BlockIndex b = 0; b < lattice.tree.block_count(); ++b) {
      if (loads[b] == 0) continue;
      const double place = lattice.center_of(b)[axis];
      double& l = low[zones.of(b, 0)];
      double& h = high[zones.of(b, 0)];
      l = std::min(l, place), h = std::max(h, place);
    }
    for (int z = 0; z < 3; ++z) EXPECT_LT(high[z], low[z + 1] + 0.06) << "axis " << axis;
  }
}

TEST(Coarsen, finds_the_largest_cubes_below_a_load) {
  const Tree lattice(fields::around_unit_sphere(0.08, 0.4));
  const std::vector<Load> loads = lattice.loads({{-1, -1, -1}, {0.5, 1, 1}});
  const Load all = std::accumulate(loads.begin(), loads.end(), Load{0}), most = all / 100;
  std::uint64_t after = 0;
  Load sum = 0;
  for (const CoarseCell& cell : coarsen(lattice.tree, loads, most)) {
    EXPECT_GE(cell.key, after);
    after = cell.key + (1ULL << 3 * (sizing::finest_level - cell.level));
    const int shift = 3 * (sizing::finest_level - cell.level + 1);
    Load load = 0, edges = 0, of_parent = 0;
    for (BlockIndex b = 0; b < lattice.tree.block_count(); ++b) {
      const std::uint64_t key = lattice.tree.cube(b).key();
      if (key >> shift == cell.key >> shift) of_parent += loads[b];
      if (key < cell.key || key >= after) continue;
      load += loads[b];
      edges += loads[b] * lattice.tree.cube(b).edge();
    }
    EXPECT_GT(load, 0);
    EXPECT_TRUE(load <= most || cell.is_block);
    EXPECT_GT(of_parent, most);
    EXPECT_EQ(cell.load, load);
    EXPECT_EQ(cell.edges, edges);
    sum += load;
  }
  EXPECT_EQ(sum, all);
}

TEST(ZoneCuts, copes_with_fewer_blocks_than_zones) {
  const auto field = fields::uniform(0.5);
  const Tree lattice(field);
  std::vector<Load> loads(lattice.tree.block_count(), 0);
  loads[3] = 5, loads[10] = 1, loads[11] = 1;
  const Zones zones = cut_into_zones(lattice.tree, loads, 8);
  EXPECT_EQ(zones.count(), 8);
  for (const BlockIndex b : {3, 10, 11}) {
    EXPECT_GE(zones.of(b, 0), 0);
    EXPECT_LT(zones.of(b, 0), 8);
  }
}

TEST(LoadOf, counts_tetrahedra_at_points_and_triangles) {
  EXPECT_EQ(tetrahedra_of(load_of(0, 3, 0)), 6);
  EXPECT_EQ(tetrahedra_of(load_of(16, 0, 0)), 92);
  EXPECT_EQ(tetrahedra_of(load_of(4, 10, 0)), 43);
  EXPECT_EQ(tetrahedra_of(load_of(16, 0, 16)), 78);
  EXPECT_EQ(load_of(0, 0, 4), 0);
}

/// Four zones of a coarse lattice, and a block of each with eight leaves.
struct Cut {
  Cut() : lattice(fields::uniform(0.3)), zones(cut_into_zones(lattice.tree, lattice.loads(), 4)) {
    for (BlockIndex b = 0; b < lattice.tree.block_count(); ++b) {
      if (lattice.tree.leaf_count(b) == 8) blocks[zones.of(b, 0)] = b;
    }
  }
  void reassign(BlockIndex b, int child, ZoneIndex to) {
    zones.reassign({lattice.tree.number(b), child, GridBox::of(lattice.tree.leaf(b, child)), to});
  }
  Tree lattice;
  Zones zones;
  std::array<BlockIndex, 4> blocks{};
};

TEST(Zones, reassign_leaves) {
  Cut cut;
  Zones& zones = cut.zones;
  const auto [a, b, c, d] = cut.blocks;
  cut.reassign(b, 5, 0);
  cut.reassign(b, 2, 2);
  cut.reassign(a, 7, 2);
  cut.reassign(b, 2, 0);  // a second time counts
  EXPECT_EQ(zones.of(b, 5), 0);
  EXPECT_EQ(zones.of(b, 2), 0);
  EXPECT_EQ(zones.of(a, 7), 2);
  for (const int child : {0, 1, 3, 4, 6, 7}) EXPECT_EQ(zones.of(b, child), 1);
  for (int child = 0; child < 7; ++child) EXPECT_EQ(zones.of(a, child), 0);
  EXPECT_EQ(zones.of(c, 0), 2);
  EXPECT_FALSE(zones.is_whole(a));
  EXPECT_FALSE(zones.is_whole(b));
  EXPECT_TRUE(zones.is_whole(c));
  EXPECT_TRUE(zones.is_whole(d));
  EXPECT_TRUE(zones.has(0, b) && zones.has(1, b) && !zones.has(2, b));
}

TEST(Zones, merge_blocks_and_reassigned_leaves) {
  Cut cut;
  Zones& zones = cut.zones;
  const auto [a, b, c, d] = cut.blocks;
  cut.reassign(a, 3, 2);
  cut.reassign(c, 4, 1);
  zones.merge(2, 0);
  EXPECT_EQ(zones.of(a, 3), 0);
  EXPECT_EQ(zones.of(c, 0), 0);
  EXPECT_EQ(zones.of(c, 4), 1);
  EXPECT_EQ(zones.of(b, 0), 1);
  EXPECT_EQ(zones.of(d, 7), 3);
  EXPECT_EQ(zones.name(2), 0);
  zones.merge(1, 0);
  for (const BlockIndex of : {a, b, c}) {
    for (int child = 0; child < 8; ++child) EXPECT_EQ(zones.of(of, child), 0);
  }
}

TEST(ZoneCuts, tell_which_zones_blocks_in_a_cube_may_be_of) {
  const Cut cut;
  const LatticeTree& tree = cut.lattice.tree;
  const ZoneCuts& cuts = cut.zones.cuts();
  for (const GridCube& cube :
       {GridCube{}, GridCube{}.child(3), GridCube{}.child(3).child(4), tree.cube(20)}) {
    std::vector<ZoneIndex> zones, found;
    cuts.for_each_zone_in(cube, [&](ZoneIndex zone) { zones.push_back(zone); });
    EXPECT_EQ(cuts.zone_of_all(cube), zones.size() == 1 ? zones[0] : no_zone);
    for (BlockIndex b = 0; b < tree.block_count(); ++b) {
      if (!GridBox::of(tree.cube(b)).dilated(-0.5).overlaps(GridBox::of(cube))) continue;
      EXPECT_TRUE(tree.level(b) < cube.level ||
                  std::find(zones.begin(), zones.end(), cuts.zone_of(tree.cube(b))) != zones.end());
    }
  }
}

}  // namespace
}  // namespace aeroloom::volume
