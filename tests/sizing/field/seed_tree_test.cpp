#include "sizing/field/seed_tree.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

using namespace aeroloom::sizing;

namespace {

SeedTree tree_of(const aeroloom::parallel::Communicator& alone, const std::vector<SizeSeed>& seeds) {
  const SharedSeeds shared(Subtrees(alone, {}, 1), seeds);
  return SeedTree({&shared}, 0.3);
}

class Random {
public:
  explicit Random(unsigned seed) : _random(seed) {}
  std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(_random() % end); }
  GridPoint point() { return {below(grid_size + 1), below(grid_size + 1), below(grid_size + 1)}; }
  /// Cubes of all sizes, many of them in one corner of the grid, and points.
  std::vector<SizeSeed> seeds(int count) {
    std::vector<SizeSeed> seeds;
    for (int i = 0; i < count; ++i) {
      const std::uint32_t edge = i % 5 == 0 ? 0 : 1U << below(10), span = i % 3 == 0 ? grid_size : 4096;
      const std::uint32_t unit = std::max(1U, edge);
      const auto at = [&] { return below(span / unit) * unit; };
      seeds.push_back({{at(), at(), at()}, edge, 1.0 + below(1000)});
    }
    return seeds;
  }

private:
  std::mt19937_64 _random;
};

double outside(std::uint32_t at, std::uint32_t low, std::uint32_t high) {
  return std::max({0.0, static_cast<double>(low) - at, static_cast<double>(at) - high});
}

double least_of_all(const std::vector<SizeSeed>& seeds, double slope, GridPoint p, double bound) {
  for (const SizeSeed& s : seeds) {
    const double x = outside(p.x, s.low.x, s.low.x + s.edge), y = outside(p.y, s.low.y, s.low.y + s.edge),
                 z = outside(p.z, s.low.z, s.low.z + s.edge);
    bound = std::min(bound, s.size + slope * std::sqrt(x * x + y * y + z * z));
  }
  return bound;
}

}  // namespace

TEST(SeedTree, FindsTheCheapestToTheLastBitFromAnyStart) {
  const auto alone = aeroloom::parallel::Communicator::self();
  Random random(3);
  for (const int count : {1, 7, 8, 9, 64, 65, 700, 5000}) {
    const std::vector<SizeSeed> seeds = random.seeds(count);
    const SeedTree tree = tree_of(alone, seeds);
    std::int32_t follows = -1;
    for (int i = 0; i < 300; ++i) {
      const GridPoint p = i % 2 ? random.point() : GridPoint{random.below(5000), random.below(5000), 77};
      for (const double bound : {1e30, 800.0}) {
        const double expected = least_of_all(seeds, 0.3, p, bound);
        std::int32_t unknown = -1, far = static_cast<std::int32_t>(random.below(count));
        ASSERT_EQ(tree.cheapest(p, bound, unknown), expected);
        ASSERT_EQ(tree.cheapest(p, bound, far), expected);
        ASSERT_EQ(tree.cheapest(p, bound, follows), expected);
        ASSERT_EQ(unknown < 0, expected == bound);
      }
      const double least = least_of_all(seeds, 0.3, p, 1e30);
      ASSERT_FALSE(tree.offers_less(p, least));
      ASSERT_TRUE(tree.offers_less(p, std::nextafter(least, 1e30)));
    }
  }
}

TEST(SeedTree, WithoutSeedsTheBoundCounts) {
  const auto alone = aeroloom::parallel::Communicator::self();
  std::int32_t near = -1;
  EXPECT_EQ(SeedTree().cheapest({1, 2, 3}, 5, near), 5);
  EXPECT_EQ(tree_of(alone, {}).cheapest({1, 2, 3}, 5, near), 5);
  EXPECT_FALSE(tree_of(alone, {}).offers_less({1, 2, 3}, 5));
  EXPECT_EQ(near, -1);
}
