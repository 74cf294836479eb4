#include "sizing/field/subtrees.hpp"

#include "parallel/communication/imposed_nodes.hpp"
#include "sizing/field/octree.hpp"
#include "sizing/field/seed_tree.hpp"

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

using namespace aeroloom::sizing;
using aeroloom::parallel::Communicator;
using aeroloom::parallel::Rank;

namespace {

constexpr std::uint64_t end_of_root = 1ULL << 3 * finest_level;

struct Cell {
  std::uint64_t key;
  std::uint8_t level;
};

/// The low corners of random cells, along the curve, many of them in one corner of the root; the same on
/// every rank.
std::vector<Cell> random_cells(unsigned seed, int count) {
  std::mt19937_64 random(seed);
  std::vector<Cell> cells;
  for (int i = 0; i < count; ++i) {
    const int level = 1 + static_cast<int>(random() % finest_level), below = 3 * (finest_level - level);
    const std::uint64_t key = random() >> (i % 3 == 0 ? 4 : 22);
    cells.push_back({key >> below << below, static_cast<std::uint8_t>(level)});
  }
  std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.key < b.key; });
  return cells;
}

/// Subtrees of cells, of which every rank gives each so-and-so-many-th.
Subtrees subtrees_of(const Communicator& ranks, const std::vector<Cell>& cells, std::int64_t most) {
  std::vector<std::uint64_t> keys;
  std::vector<std::uint8_t> levels;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (static_cast<Rank>(i % ranks.size()) != ranks.rank()) continue;
    keys.push_back(cells[i].key), levels.push_back(cells[i].level);
  }
  return {ranks, {keys, levels}, most};
}

/// Of two lists, each with every other seed.
SeedTree tree_of(const Communicator& ranks, const std::vector<SizeSeed>& own) {
  std::vector<SizeSeed> odd, even;
  for (std::size_t i = 0; i < own.size(); ++i) (i % 2 == 1 ? odd : even).push_back(own[i]);
  const Subtrees root(ranks, {}, 1);
  const SharedSeeds first(root, odd), second(root, even);
  return SeedTree({&first, &second}, 0.3);
}

/// All ranks, on one node and as if on several.
std::vector<Communicator> nodes_of_world() {
  const Communicator world = Communicator::world();
  return {world, aeroloom::parallel::impose_nodes(world, 1), aeroloom::parallel::impose_nodes(world, 2)};
}

std::uint64_t size_of(const Subtrees& subtrees, std::size_t subtree) {
  return 1ULL << 3 * (finest_level - subtrees.level(subtree));
}

}  // namespace

TEST(Subtrees, TileTheRootAndHoldFewCells) {
  const Communicator world = Communicator::world();
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const std::vector<Cell> cells = random_cells(seed, 400);
    const Subtrees subtrees = subtrees_of(world, cells, 20);
    EXPECT_GT(subtrees.count(), 50U);
    std::uint64_t end = 0;
    for (std::size_t subtree = 0; subtree < subtrees.count(); ++subtree) {
      ASSERT_EQ(subtrees.key(subtree), end);
      ASSERT_EQ(subtrees.find(end), subtree);
      end += size_of(subtrees, subtree);
      ASSERT_EQ(subtrees.find(end - 1), subtree);
      const auto lies_within = [&](const Cell& c) { return c.key >= subtrees.key(subtree) && c.key < end; };
      const auto is_smaller = [&](const Cell& c) {
        return lies_within(c) && c.level > subtrees.level(subtree);
      };
      EXPECT_TRUE(std::count_if(cells.begin(), cells.end(), lies_within) <= 20 ||
                  std::none_of(cells.begin(), cells.end(), is_smaller));
    }
    EXPECT_EQ(end, end_of_root);
  }
}

TEST(Subtrees, AreSharedAlikeInTheirOrder) {
  const Communicator world = Communicator::world();
  const std::vector<Cell> cells = random_cells(3, 2000);
  const Subtrees subtrees = subtrees_of(world, cells, 20);
  std::vector<double> of_subtrees(subtrees.count(), 1), work(static_cast<std::size_t>(world.size()));
  for (const Cell& cell : cells) of_subtrees[subtrees.find(cell.key)] += 1;
  std::size_t next = 0;
  for (Rank rank = 0; rank < world.size(); ++rank) {
    const IndexRange own = subtrees.of_rank(rank);
    ASSERT_EQ(own.first, next);
    next = own.last;
    for (std::size_t subtree = own.first; subtree < own.last; ++subtree) {
      ASSERT_EQ(subtrees.owner(subtree), rank);
      work[rank] += of_subtrees[subtree];
    }
  }
  EXPECT_EQ(next, subtrees.count());
  const double mean = static_cast<double>(cells.size() + subtrees.count()) / world.size();
  for (const double each : work)
    EXPECT_NEAR(each, mean, *std::max_element(of_subtrees.begin(), of_subtrees.end()));
}

TEST(Subtrees, OfOneSpotMayLeaveRanksWithout) {
  const Communicator world = Communicator::world();
  const Subtrees subtrees = subtrees_of(world, std::vector<Cell>(30, {0, 5}), 1000);
  ASSERT_EQ(subtrees.count(), 1U);
  std::size_t all = 0;
  for (Rank rank = 0; rank < world.size(); ++rank) all += subtrees.of_rank(rank).size();
  EXPECT_EQ(all, 1U);
  EXPECT_EQ(subtrees.of_rank(subtrees.owner(0)).size(), 1U);
}

TEST(SplitCubes, AreBalancedOverSubtreesAsInOne) {
  const std::vector<Communicator> nodes = nodes_of_world();
  const Communicator& world = nodes.front();
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const std::vector<Cell> cells = random_cells(seed, 40 * static_cast<int>(seed));
    SplitCubes alone, divided(subtrees_of(world, cells, 4));
    const IndexRange own = divided.own_subtrees();
    for (const Cell& cell : cells) {
      alone.split(cell.key, cell.level - 1);
      const std::size_t subtree = divided.subtrees().find(cell.key);
      if (subtree >= own.first && subtree < own.last) divided.split(cell.key, cell.level - 1);
    }
    alone.balance(), divided.balance();
    const SplitCubes::Leaves expected = alone.leaves(), mine = divided.leaves();
    EXPECT_EQ(divided.leaf_count(), static_cast<std::int64_t>(expected.keys.size()));
    ASSERT_EQ(world.all_gather_items<std::uint64_t>(mine.keys), expected.keys);
    ASSERT_EQ(world.all_gather_items<std::uint8_t>(mine.levels), expected.levels);

    const LeafTable of_all(expected);
    for (const Communicator& ranks : nodes) {
      const LeafTable of_subtrees(subtrees_of(ranks, cells, 4), mine, expected);
      std::mt19937_64 random(seed);
      for (int i = 0; i < 5000; ++i) {
        const std::uint64_t start = expected.keys[random() % expected.keys.size()];
        const std::uint64_t key = i % 2 ? random() >> 4 : start + random() % 2;
        ASSERT_EQ(of_subtrees.find(key), of_all.find(key));
      }
    }
  }
}

TEST(SeedTree, OfManyRanksFindsTheCheapest) {
  for (const Communicator& world : nodes_of_world()) {
    for (const int count : {1, 50, 3000}) {
      std::vector<SizeSeed> seeds, mine;
      std::mt19937_64 random(7);
      for (const Cell& cell : random_cells(5, count))
        seeds.push_back(
            {grid_point(cell.key), grid_size >> cell.level, 1.0 + static_cast<double>(random() % 9999)});
      const IndexRange own = even_part(seeds.size(), world.rank(), world.size());
      for (std::size_t i = own.first; i < own.last; ++i) mine.push_back(seeds[i]);
      const SeedTree whole = tree_of(Communicator::self(), seeds), shared = tree_of(world, mine);
      for (int i = 0; i < 500; ++i) {
        const GridPoint p = grid_point(random() >> 4);
        std::int32_t near = -1, near_shared = -1;
        ASSERT_EQ(shared.cheapest(p, 1e30, near_shared), whole.cheapest(p, 1e30, near));
      }
    }
  }
}
