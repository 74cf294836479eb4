#include "sizing/field/octree.hpp"

#include "geometry/sort_unique.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>
#include <set>
#include <span>

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

OctreeNodes collect_all(const SplitCubes::Leaves& leaves, const LeafTable& table) {
  return collect_nodes(leaves, table, {0, leaves.keys.size()});
}

std::vector<std::uint64_t> keys_of(std::span<const GridPoint> points) {
  std::vector<std::uint64_t> keys;
  for (const GridPoint p : points) keys.push_back(morton_key(p));
  aeroloom::geometry::sort_unique(keys);
  return keys;
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
  const LeafTable table(leaves);
  const OctreeNodes nodes = collect_all(leaves, table);
  for (const GridPoint p : nodes.points) {
    int low = finest_level, high = 0;
    for (int octant = 0; octant < 8; ++octant) {
      const GridPoint cell{p.x - (octant & 1 ? 0 : 1), p.y - (octant & 2 ? 0 : 1),
                           p.z - (octant & 4 ? 0 : 1)};
      if (cell.x >= grid_size || cell.y >= grid_size || cell.z >= grid_size) continue;
      const std::int32_t leaf = table.find(morton_key(cell));
      low = std::min<int>(low, leaves.levels[leaf]);
      high = std::max<int>(high, leaves.levels[leaf]);
    }
    ASSERT_LE(high - low, 1);
  }
}

TEST(Octree, NodesAreTheDistinctCorners) {
  const auto leaves = random_splits(4, 30).leaves();
  const OctreeNodes nodes = collect_all(leaves, LeafTable(leaves));
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
  const OctreeNodes nodes = collect_all(leaves, LeafTable(leaves));
  ASSERT_FALSE(nodes.hanging.empty());
  std::set<std::uint64_t> hangs;
  for (const auto& hanging : nodes.hanging) hangs.insert(morton_key(nodes.points[hanging.node]));
  for (const auto& hanging : nodes.hanging) {
    ASSERT_TRUE(hanging.count == 2 || hanging.count == 4);
    std::uint64_t x = 0, y = 0, z = 0;
    for (int i = 0; i < hanging.count; ++i) {
      const GridPoint p = hanging.masters[i];
      x += p.x, y += p.y, z += p.z;
      ASSERT_FALSE(hangs.contains(morton_key(p)));
      ASSERT_EQ(morton_key(nodes.points.at(hanging.master_nodes[i])), morton_key(p));
    }
    const GridPoint p = nodes.points[hanging.node];
    ASSERT_EQ(x, std::uint64_t{p.x} * hanging.count);
    ASSERT_EQ(y, std::uint64_t{p.y} * hanging.count);
    ASSERT_EQ(z, std::uint64_t{p.z} * hanging.count);
  }
}

TEST(Octree, RangesOfLeavesHaveTheirCornersAndHangingOnes) {
  const auto leaves = random_splits(6, 30).leaves();
  const LeafTable table(leaves);
  const OctreeNodes all = collect_all(leaves, table);
  std::map<std::uint64_t, std::vector<std::uint64_t>> masters;
  for (const auto& hanging : all.hanging)
    masters[morton_key(all.points[hanging.node])] = keys_of(std::span(hanging.masters).first(hanging.count));
  const std::size_t count = leaves.keys.size();
  for (const std::size_t parts : {2U, 3U, 7U}) {
    for (std::size_t part = 0; part < parts; ++part) {
      const std::size_t first = count * part / parts, last = count * (part + 1) / parts;
      const OctreeNodes some = collect_nodes(leaves, table, {first, last});
      ASSERT_EQ(some.corners.size(), 8 * (last - first));
      EXPECT_EQ(keys_of(some.points).size(), some.points.size());
      for (std::size_t i = 0; i < some.corners.size(); ++i) {
        ASSERT_EQ(morton_key(some.points[some.corners[i]]),
                  morton_key(all.points[all.corners[8 * first + i]]));
      }
      std::set<std::uint64_t> hanging_here;
      for (const auto& hanging : some.hanging) {
        const std::uint64_t key = morton_key(some.points[hanging.node]);
        hanging_here.insert(key);
        for (int m = 0; m < hanging.count; ++m) {
          if (hanging.master_nodes[m] < 0) continue;
          ASSERT_EQ(morton_key(some.points[hanging.master_nodes[m]]), morton_key(hanging.masters[m]));
        }
        ASSERT_EQ(keys_of(std::span(hanging.masters).first(hanging.count)), masters.at(key));
      }
      for (const GridPoint p : some.points)
        ASSERT_EQ(hanging_here.contains(morton_key(p)), masters.contains(morton_key(p)));
    }
  }
}

TEST(Octree, MastersOfALeafAreThoseOfItsHangingCorners) {
  const auto leaves = random_splits(8, 40).leaves();
  const LeafTable table(leaves);
  const OctreeNodes nodes = collect_all(leaves, table);
  std::map<std::int32_t, const OctreeNodes::Hanging*> hanging;
  for (const auto& each : nodes.hanging) hanging[each.node] = &each;
  int leaves_with = 0;
  for (std::size_t leaf = 0; leaf < leaves.keys.size(); ++leaf) {
    std::vector<GridPoint> expected;
    for (int corner = 0; corner < 8; ++corner) {
      const auto at = hanging.find(nodes.corners[8 * leaf + corner]);
      if (at == hanging.end()) continue;
      const auto& masters = at->second->masters;
      expected.insert(expected.end(), masters.begin(), masters.begin() + at->second->count);
    }
    leaves_with += !expected.empty();
    ASSERT_EQ(keys_of(masters_of_corners(leaves, table, static_cast<std::int32_t>(leaf))), keys_of(expected));
  }
  EXPECT_GT(leaves_with, 20);
}
