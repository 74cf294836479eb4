#include "volume/lattice/forest.hpp"

#include "parallel/communication/collective_error.hpp"
#include "sizing/field/octree.hpp"

#include <map>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace aeroloom::forest {
namespace {

using geometry::finest_level;
using geometry::GridCube;
using geometry::GridPoint;
using parallel::Communicator;

/// Cubes that are to be split, whatever is asked of those above them.
class Splits {
public:
  void add(const GridCube& cube) {
    _split.insert(name_of(cube));
    for (int level = 0; level < cube.level; ++level) _above.insert(name_of(ancestor(cube, level)));
  }
  RefineFlag operator()(const GridCube& cube) const {
    if (_split.contains(name_of(cube))) return RefineFlag::split;
    return _above.contains(name_of(cube)) ? RefineFlag::descend : RefineFlag::keep;
  }
  /// The leaves as another octree has them.
  Octants leaves() const {
    sizing::SplitCubes cubes;
    for (const auto& [level, key] : _split) cubes.split(key, level);
    cubes.balance();
    const auto [keys, levels] = cubes.leaves();
    return {keys, levels};
  }

  static GridCube ancestor(const GridCube& cube, int level) {
    const std::uint32_t inside = (geometry::grid_size >> level) - 1;
    return {{cube.low.x & ~inside, cube.low.y & ~inside, cube.low.z & ~inside}, level};
  }

private:
  using Name = std::pair<int, std::uint64_t>;
  static Name name_of(const GridCube& cube) { return {cube.level, cube.key()}; }
  std::set<Name> _split, _above;
};

GridCube random_cube(std::mt19937_64& random, int coarsest, int finest) {
  const int level = coarsest + static_cast<int>(random() % (finest - coarsest + 1));
  const GridCube finest_cube{geometry::grid_point(random() >> 4), finest_level};
  return Splits::ancestor(finest_cube, level);
}

/// Of all kinds: none, the root alone, cubes of the uppermost levels, some down to the finest, in one corner.
std::vector<Splits> examples() {
  std::vector<Splits> all(2);
  all[1].add({{}, 0});
  for (unsigned seed = 1; seed <= 12; ++seed) {
    std::mt19937_64 random(seed);
    Splits splits;
    for (unsigned i = 0; i < seed % 4 + 1; ++i)
      splits.add(random_cube(random, 1, 2 + static_cast<int>(seed % 3)));
    all.push_back(splits);
    splits.add(random_cube(random, finest_level - 2, finest_level - 1));
    all.push_back(splits);
  }
  for (unsigned seed = 1; seed <= 4; ++seed) {
    std::mt19937_64 random(seed);
    Splits splits;
    for (unsigned i = 0; i < 4 + 8 * seed; ++i) splits.add(random_cube(random, 0, finest_level - 1));
    all.push_back(splits);
  }
  Splits corner;
  corner.add({{}, 5});
  all.push_back(corner);
  Splits far_corner;
  far_corner.add(Splits::ancestor({geometry::grid_point((1ULL << 3 * finest_level) - 1), finest_level},
                                  finest_level - 1));
  all.push_back(far_corner);
  return all;
}

Octants all_leaves(const Communicator& communicator, const Forest& forest) {
  return {communicator.all_gather_items<std::uint64_t>(forest.local().keys),
          communicator.all_gather_items<std::uint8_t>(forest.local().levels)};
}

parallel::Rank owner_of_number(const Forest& forest, std::int64_t number) {
  parallel::Rank owner = 0;
  while (forest.first(owner + 1) <= number) ++owner;
  return owner;
}

void expect_sound(const Communicator& communicator, const Forest& forest, const Octants& expected) {
  const Octants all = all_leaves(communicator, forest);
  ASSERT_EQ(all.keys, expected.keys);
  ASSERT_EQ(all.levels, expected.levels);
  ASSERT_EQ(forest.count(), static_cast<std::int64_t>(expected.size()));
  const auto first = static_cast<std::size_t>(forest.first(communicator.rank()));
  ASSERT_EQ(forest.first(communicator.rank() + 1) - forest.first(communicator.rank()),
            static_cast<std::int64_t>(forest.local().size()));
  for (std::size_t i = 0; i < forest.local().size(); ++i)
    ASSERT_EQ(forest.local().keys[i], expected.keys[first + i]);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const parallel::Rank owner = owner_of_number(forest, static_cast<std::int64_t>(i));
    const std::uint64_t last = expected.keys[i] + (1ULL << 3 * (finest_level - expected.levels[i])) - 1;
    ASSERT_EQ(forest.owner_of(expected.keys[i]), owner);
    ASSERT_EQ(forest.owner_of(last), owner);
    ASSERT_LE(forest.first(owner), static_cast<std::int64_t>(i));
    ASSERT_GT(forest.first(owner + 1), static_cast<std::int64_t>(i));
    const std::int64_t here = owner == communicator.rank() ? static_cast<std::int64_t>(i - first) : -1;
    ASSERT_EQ(forest.local().find(expected.keys[i]), here);
    ASSERT_EQ(forest.local().find(last), here);
  }
}

/// Eight leaves with one parent are on one rank.
void expect_whole_families(const Forest& forest, const Octants& all) {
  std::map<std::pair<int, std::uint64_t>, std::vector<std::int64_t>> families;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all.levels[i] > 0)
      families[{all.levels[i], all.keys[i] >> 3 * (finest_level - all.levels[i] + 1)}].push_back(
          static_cast<std::int64_t>(i));
  for (const auto& [name, leaves] : families)
    if (leaves.size() == 8) {
      ASSERT_EQ(owner_of_number(forest, leaves.front()), owner_of_number(forest, leaves.back()));
    }
}

TEST(Forest, HasTheLeavesOfTheSmallestBalancedOctree) {
  const Communicator world = Communicator::world();
  for (const Splits& splits : examples()) {
    const Forest forest = grow(world, splits);
    const Octants expected = splits.leaves();
    expect_sound(world, forest, expected);
    expect_whole_families(forest, expected);
  }
}

TEST(Forest, IsPartitionedByWeight) {
  const Communicator world = Communicator::world();
  std::mt19937_64 random(5);
  for (const Splits& splits : examples()) {
    const Forest grown = grow(world, splits);
    // All weight in the second half.
    std::vector<std::int32_t> weights;
    for (std::size_t i = 0; i < grown.local().size(); ++i)
      weights.push_back(grown.first(world.rank()) + static_cast<std::int64_t>(i) >= grown.count() / 2 ? 100
                                                                                                      : 0);
    const Forest forest = partition_by_weight(grown, weights);
    const Octants expected = splits.leaves();
    expect_sound(world, forest, expected);
    expect_whole_families(forest, expected);
    if (world.size() == 1 || expected.size() < 100 * static_cast<std::size_t>(world.size())) continue;
    const std::int64_t weighty = grown.count() - grown.count() / 2, share = weighty / world.size();
    EXPECT_NEAR(static_cast<double>(forest.first(1)), static_cast<double>(grown.count() - weighty + share),
                8);
  }
}

TEST(Forest, SharesTheRefinement) {
  const Communicator world = Communicator::world();
  std::int64_t checked = 0;
  // A sphere: cubes that it meets.
  const auto criterion = [&](const GridCube& cube) {
    ++checked;
    double least = 0, most = 0;
    for (const std::uint32_t low : {cube.low.x, cube.low.y, cube.low.z}) {
      const double a = low / double{geometry::grid_size} - 0.5,
                   b = a + cube.edge() / double{geometry::grid_size};
      least += a > 0 ? a * a : b < 0 ? b * b : 0;
      most += std::max(a * a, b * b);
    }
    return cube.level < 6 && least < 0.1 && most > 0.1 ? RefineFlag::split : RefineFlag::keep;
  };
  const Forest forest = grow(world, criterion);
  EXPECT_GT(forest.count(), 20000);
  const double share = static_cast<double>(checked) / static_cast<double>(world.sum(checked));
  EXPECT_LT(share, 1.5 / world.size());
  EXPECT_LT(static_cast<double>(forest.local().size()),
            1.01 * static_cast<double>(forest.count()) / world.size() + 16);
}

TEST(Forest, SaysWhatItsCriterionThrows) {
  const Communicator world = Communicator::world();
  for (const int bad_level : {0, 1, 2, 4}) {
    const auto criterion = [&](const GridCube& cube) {
      if (cube.level == bad_level) throw std::logic_error("no size there");
      return RefineFlag::split;
    };
    try {
      grow(world, criterion);
      ADD_FAILURE() << "nothing was thrown";
    } catch (const parallel::CollectiveError& error) {
      EXPECT_EQ(error.kind(), parallel::FailureKind::bug);
      EXPECT_EQ(std::string(error.what()).find("no size there"), 0u);
    }
  }
}

TEST(Forest, StopsBeforeItIsTooLarge) {
  const Communicator world = Communicator::world();
  const auto endless = [](const GridCube&) { return RefineFlag::split; };
  try {
    grow(world, endless, 5000);
    ADD_FAILURE() << "nothing was thrown";
  } catch (const parallel::CollectiveError& error) {
    EXPECT_EQ(error.kind(), parallel::FailureKind::resources);
    EXPECT_NE(std::string(error.what()).find("5000"), std::string::npos);
  }
}

}  // namespace
}  // namespace aeroloom::forest
