#include "sizing/field/corner_sizes.hpp"

#include "parallel/communication/imposed_nodes.hpp"
#include "sizing/field/octree.hpp"
#include "tests/several_ranks.hpp"

#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

using namespace aeroloom::sizing;
using aeroloom::parallel::Communicator;
using aeroloom::parallel::NodeArray;
using aeroloom::parallel::Rank;

namespace {

SplitCubes::Leaves random_leaves(unsigned seed, int count) {
  std::mt19937_64 random(seed);
  SplitCubes cells;
  for (int i = 0; i < count; ++i) cells.split(random() >> 4, static_cast<int>(random() % 8));
  cells.balance();
  return cells.leaves();
}

/// A size that no other point has.
float size_at(std::uint64_t key, int level, int corner) {
  const std::uint32_t edge = grid_size >> level;
  const GridPoint low = grid_point(key);
  const GridPoint p{low.x + (corner & 1 ? edge : 0), low.y + (corner & 2 ? edge : 0),
                    low.z + (corner & 4 ? edge : 0)};
  std::mt19937_64 random(morton_key(p));
  return static_cast<float>(random() % (1U << 24));
}

std::vector<float> sizes_of(const SplitCubes::Leaves& leaves, IndexRange range) {
  std::vector<float> sizes;
  for (std::size_t leaf = range.first; leaf < range.last; ++leaf) {
    for (int corner = 0; corner < 8; ++corner)
      sizes.push_back(size_at(leaves.keys[leaf], leaves.levels[leaf], corner));
  }
  return sizes;
}

void expect_sizes(const CornerSizes& sizes, const SplitCubes::Leaves& leaves) {
  for (std::size_t leaf = 0; leaf < leaves.keys.size(); ++leaf) {
    for (int corner = 0; corner < 8; ++corner)
      ASSERT_EQ(sizes.of_leaf(leaf)(corner), size_at(leaves.keys[leaf], leaves.levels[leaf], corner));
  }
}

Octree octree_of(const Communicator& ranks, const SplitCubes::Leaves& leaves) {
  return {ranks, NodeArray(leaves.keys), NodeArray(leaves.levels), {}};
}

CornerSizes made_by(const Communicator& ranks, const SplitCubes::Leaves& leaves) {
  const Octree octree = octree_of(ranks, leaves);
  const IndexRange own = CornerSizes::part_of(octree, ranks.rank());
  return {octree, CornerSizes::pack(leaves, own, sizes_of(leaves, own))};
}

}  // namespace

TEST(CornerSizes, AreWhatWasGivenOnAnyNodes) {
  const Communicator world = Communicator::world();
  for (const int ranks_per_node : {1, 2, 100}) {
    const Communicator ranks = aeroloom::parallel::impose_nodes(world, ranks_per_node);
    for (unsigned seed = 0; seed < 6; ++seed) {
      const SplitCubes::Leaves leaves = random_leaves(seed, static_cast<int>(10 * seed));
      expect_sizes(made_by(ranks, leaves), leaves);
    }
  }
}

TEST(CornerSizes, AreHeldAlikeByAnyNumberOfRanks) {
  NEEDS_SEVERAL_RANKS();
  const Communicator world = Communicator::world();
  const SplitCubes::Leaves leaves = random_leaves(7, 60);
  const auto packed = made_by(world, leaves).packed(), alone = made_by(Communicator::self(), leaves).packed();
  ASSERT_EQ(packed.size(), alone.size());
  for (std::size_t i = 0; i < packed.size(); ++i) ASSERT_EQ(packed[i], alone[i]);
  EXPECT_LT(packed.size(), 5 * leaves.keys.size());
}

TEST(CornerSizes, OfAFamilyAreHeldOnce) {
  SplitCubes cells;
  for (std::uint64_t cell = 0; cell < 64; ++cell) cells.split(cell << 3 * (finest_level - 2), 2);
  cells.balance();
  const SplitCubes::Leaves leaves = cells.leaves();
  ASSERT_EQ(leaves.keys.size(), 512U);
  EXPECT_EQ(made_by(Communicator::self(), leaves).packed().size(), 8U * 125);
}

TEST(CornerSizes, PartsTileTheLeaves) {
  const Communicator world = Communicator::world();
  const SplitCubes::Leaves leaves = random_leaves(3, 60);
  const Octree octree = octree_of(world, leaves);
  std::size_t next = 0;
  for (Rank rank = 0; rank < world.size(); ++rank) {
    const IndexRange part = CornerSizes::part_of(octree, rank);
    EXPECT_EQ(part.first, next);
    next = part.last;
  }
  EXPECT_EQ(next, leaves.keys.size());
}

TEST(CornerSizes, ComeBackFromWhatIsHeld) {
  const Communicator world = Communicator::world();
  const SplitCubes::Leaves leaves = random_leaves(5, 60);
  const NodeArray<float> packed = made_by(world, leaves).packed();
  const Octree octree = octree_of(world, leaves);
  expect_sizes(CornerSizes::unpacked(octree, packed), leaves);
  const NodeArray<float> short_of_one({packed.data(), packed.data() + packed.size() - 1});
  EXPECT_THROW(CornerSizes::unpacked(octree, short_of_one), std::logic_error);
}
