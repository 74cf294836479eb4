#include "sizing/octree.hpp"

#include <cstdlib>
#include <random>

#include <gtest/gtest.h>

using namespace aeroloom::sizing;

namespace {

SplitCubes random_splits(unsigned seed, int count) {
  std::mt19937_64 random(seed);
  SplitCubes cells;
  for (int i = 0; i < count; ++i) {
    const int level = static_cast<int>(random() % finest_level);
    cells.split(random() >> 4, level);
  }
  cells.balance();
  return cells;
}

}  // namespace

TEST(Morton, KeysAndPointsCorrespond) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    const GridPoint p{static_cast<std::uint32_t>(random() % (grid_size + 1)),
                      static_cast<std::uint32_t>(random() % (grid_size + 1)),
                      static_cast<std::uint32_t>(random() % (grid_size + 1))};
    const GridPoint q = grid_point(morton_key(p));
    EXPECT_TRUE(p.x == q.x && p.y == q.y && p.z == q.z);
  }
}

TEST(Octree, LeavesTileTheCubeAlongTheCurve) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto leaves = random_splits(seed, 20).leaves();
    std::uint64_t end = 0;
    for (std::size_t i = 0; i < leaves.keys.size(); ++i) {
      ASSERT_EQ(leaves.keys[i], end);
      end += 1ULL << 3 * (finest_level - leaves.levels[i]);
    }
    EXPECT_EQ(end, 1ULL << 3 * finest_level);
  }
}

TEST(Octree, UnsplitIsOneLeaf) {
  SplitCubes cells;
  cells.balance();
  const auto leaves = cells.leaves();
  ASSERT_EQ(leaves.keys.size(), 1U);
  EXPECT_EQ(LeafTable(leaves).find((1ULL << 60) - 1), 0);
}

TEST(Octree, SplitCellsReachTheLevelAskedFor) {
  SplitCubes cells;
  cells.split(12345678901234567ULL, finest_level - 1);
  cells.balance();
  const auto leaves = cells.leaves();
  const LeafTable table(leaves);
  EXPECT_EQ(leaves.levels[table.find(12345678901234567ULL)], finest_level);
}

TEST(Octree, TableFindsTheLeafThatHoldsTheCell) {
  const auto leaves = random_splits(7, 30).leaves();
  const LeafTable table(leaves);
  std::mt19937_64 random(2);
  for (int i = 0; i < 10000; ++i) {
    // Half of the keys close behind the start of a leaf, where small leaves are met.
    const std::uint64_t key =
        i % 2 ? random() >> 4 : leaves.keys[random() % leaves.keys.size()] + random() % 2;
    const auto after = std::upper_bound(leaves.keys.begin(), leaves.keys.end(), key);
    ASSERT_EQ(table.find(key), after - leaves.keys.begin() - 1);
  }
}

TEST(Octree, NeighboursDifferByAtMostOneLevelAroundEveryNode) {
  const auto leaves = random_splits(3, 30).leaves();
  const OctreeNodes nodes = collect_nodes(leaves, LeafTable(leaves));
  for (std::size_t n = 0; n < nodes.points.size(); ++n) {
    int low = finest_level, high = 0;
    for (int octant = 0; octant < 8; ++octant) {
      const std::int32_t leaf = nodes.leaf_around[8 * n + octant];
      if (leaf < 0) continue;
      low = std::min<int>(low, leaves.levels[leaf]);
      high = std::max<int>(high, leaves.levels[leaf]);
    }
    ASSERT_LE(high - low, 1);
  }
}

TEST(Octree, NodesAreTheDistinctCorners) {
  const auto leaves = random_splits(4, 30).leaves();
  const OctreeNodes nodes = collect_nodes(leaves, LeafTable(leaves));
  std::vector<std::uint64_t> keys;
  for (const GridPoint p : nodes.points) keys.push_back(morton_key(p));
  std::sort(keys.begin(), keys.end());
  EXPECT_EQ(std::adjacent_find(keys.begin(), keys.end()), keys.end());
  for (std::size_t leaf = 0; leaf < leaves.keys.size(); ++leaf) {
    const GridPoint low = grid_point(leaves.keys[leaf]);
    const std::uint32_t edge = grid_size >> leaves.levels[leaf];
    for (int corner = 0; corner < 8; ++corner) {
      const GridPoint p = nodes.points[nodes.corners[8 * leaf + corner]];
      ASSERT_EQ(p.x, low.x + (corner & 1 ? edge : 0));
      ASSERT_EQ(p.y, low.y + (corner & 2 ? edge : 0));
      ASSERT_EQ(p.z, low.z + (corner & 4 ? edge : 0));
    }
  }
}

TEST(Octree, HangingNodesLieMidwayBetweenMastersThatDoNotHang) {
  const auto leaves = random_splits(5, 30).leaves();
  const OctreeNodes nodes = collect_nodes(leaves, LeafTable(leaves));
  ASSERT_FALSE(nodes.hanging.empty());
  std::vector<bool> hangs(nodes.points.size(), false);
  for (const auto& hanging : nodes.hanging) hangs[hanging.node] = true;
  for (const auto& hanging : nodes.hanging) {
    ASSERT_TRUE(hanging.count == 2 || hanging.count == 4);
    std::uint64_t x = 0, y = 0, z = 0;
    for (int i = 0; i < hanging.count; ++i) {
      const GridPoint p = nodes.points[hanging.masters[i]];
      x += p.x, y += p.y, z += p.z;
      ASSERT_FALSE(hangs[hanging.masters[i]]);
    }
    const GridPoint p = nodes.points[hanging.node];
    ASSERT_EQ(x, std::uint64_t{p.x} * hanging.count);
    ASSERT_EQ(y, std::uint64_t{p.y} * hanging.count);
    ASSERT_EQ(z, std::uint64_t{p.z} * hanging.count);
  }
}
