#include "mesh/exchange/distributed_table.hpp"

#include <algorithm>
#include <array>

#include <gtest/gtest.h>

namespace aeroloom::mesh {
namespace {

using parallel::Communicator;
using Points = DistributedTable<std::array<double, 3>>;
using Words = DistributedTable<std::int64_t>;

TEST(DistributedTable, KeysFarFromOthersDoNotMoveAllToOneRank) {
  const Communicator world = Communicator::world();
  constexpr GlobalIndex count = 20'000, far = GlobalIndex{1} << 61;
  std::vector<Points::KeyedValue> points;
  std::vector<GlobalIndex> keys;
  for (GlobalIndex i = world.rank(); i < count; i += world.size()) {
    const GlobalIndex key = i < 10 ? far + i : 3 * i;
    keys.push_back(key);
    points.push_back({key, {static_cast<double>(i), 0, 0}});
  }
  Points table(world, fair_ranges(world, keys, far + 10), std::move(points));
  EXPECT_EQ(table.count(), count);
  EXPECT_LE(static_cast<GlobalIndex>(table.mine().size()), count / world.size() + count / 16);
  std::sort(keys.begin(), keys.end());
  const Points::Fetched found = table.fetch(keys);
  EXPECT_EQ(found.missing, -1);
  for (std::size_t i = 0; i < keys.size(); ++i)
    EXPECT_EQ(found.values[i][0], static_cast<double>(keys[i] >= far ? keys[i] - far : keys[i] / 3));
  // Dense keys go by even ranges, as numbers of vertices do.
  EXPECT_EQ(fair_ranges(world, keys, 0).first, even_ranges(world.size(), 0).first);
  EXPECT_EQ(fair_ranges(world, std::vector<GlobalIndex>(1000, 1), 1000).first,
            even_ranges(world.size(), 1000).first);
  EXPECT_EQ(fair_ranges(world, {}, far).first, even_ranges(world.size(), far).first);
}

/// Every rank has all the rows of some keys below `limit`, with the square as the value.
Words squares(const Communicator& world, GlobalIndex limit) {
  std::vector<Words::KeyedValue> rows;
  for (GlobalIndex key = world.rank(); key < limit; key += 2) rows.push_back({key, key * key});
  return {world, even_ranges(world.size(), limit), std::move(rows)};
}

TEST(DistributedTable, KeepsAKeyThatComesSeveralTimesOnce) {
  const Communicator world = Communicator::world();
  const Words table = squares(world, 100);
  EXPECT_EQ(table.clash(), -1);
  EXPECT_EQ(table.count(), world.size() == 1 ? 50 : 100);
  for (const Words::KeyedValue& row : table.mine()) EXPECT_EQ(row.value, row.key * row.key);
  if (world.size() < 3) return;
  std::vector<Words::KeyedValue> rows{{40 + world.rank() % 2, world.rank()}};
  EXPECT_EQ(Words(world, even_ranges(world.size(), 100), rows).clash(), 40);
}

TEST(DistributedTable, SaysWhatIsMissing) {
  const Communicator world = Communicator::world();
  const Words table = squares(world, 100);
  std::vector<GlobalIndex> keys{world.size() == 1 ? 8 : 7, 96};
  EXPECT_EQ(table.fetch(keys).values, (std::vector<std::int64_t>{keys[0] * keys[0], 96 * 96}));
  if (world.is_root()) keys = {2, 150, 160};
  EXPECT_EQ(table.fetch(keys).missing, 150);
}

TEST(DistributedTable, NumbersWhatIsUsedInTheOrderOfKeys) {
  const Communicator world = Communicator::world();
  Words table = squares(world, 200);
  // Rank r uses 20 r, 20 r + 4 and 180, which all do.
  const auto own = static_cast<GlobalIndex>(20 * world.rank());
  const Words::Numbers numbers = table.number({own, own + 4, 180}, {own, own + 2});
  const GlobalIndex first = 2 * world.rank(), last = 2 * world.size();
  EXPECT_EQ(numbers.used, (std::vector<GlobalIndex>{first, first + 1, last}));
  EXPECT_EQ(numbers.others, (std::vector<GlobalIndex>{first, -1}));
  EXPECT_EQ(numbers.shared, (std::vector<std::uint8_t>{0, 0, world.size() > 1}));
  EXPECT_EQ(table.count(), last + 1);
  EXPECT_EQ(table.fetch({first + 1, last}).values,
            (std::vector<std::int64_t>{(own + 4) * (own + 4), 180 * 180}));
}

}  // namespace
}  // namespace aeroloom::mesh
