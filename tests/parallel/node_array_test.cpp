#include "aeroloom/parallel/communication/node_array.hpp"

#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

std::vector<std::int64_t> squares(std::int64_t count) {
  std::vector<std::int64_t> items;
  for (std::int64_t i = 0; i < count; ++i) items.push_back(i * i);
  return items;
}

/// Whether the system's map of this process has the address in a file that others may have mapped too.
bool lies_in_shared_memory(const void* at) {
  std::ifstream maps("/proc/self/maps");
  const auto address = reinterpret_cast<std::uintptr_t>(at);
  for (std::string line; std::getline(maps, line);) {
    std::uintptr_t first = 0, last = 0;
    char dash = 0;
    std::istringstream(line) >> std::hex >> first >> dash >> last;
    if (address >= first && address < last) return line.find("memfd:aeroloom") != std::string::npos;
  }
  return false;
}

TEST(NodeArrayTest, HoldsItsItems) {
  const Communicator world = Communicator::world();
  for (const std::int64_t count : {0, 1, 1000, 3'000'000}) {
    const NodeArray<std::int64_t> shared(world, squares(count));
    ASSERT_EQ(shared.size(), static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) ASSERT_EQ(shared[i], i * i);
  }
}

TEST(NodeArrayTest, LiesInMemoryOfTheNodeWhereThereAreOthers) {
  const Communicator world = Communicator::world();
  const NodeArray<std::int64_t> shared(world, squares(1000)), own(squares(1000));
  EXPECT_EQ(lies_in_shared_memory(shared.data()), world.size() > 1);
  EXPECT_FALSE(lies_in_shared_memory(own.data()));
}

TEST(NodeArrayTest, GathersWhatRanksHaveInTheirOrder) {
  const Communicator world = Communicator::world();
  for (const std::int64_t most : {0, 1, 7, 100'000}) {
    // Every third rank has nothing.
    const auto count_of = [&](Rank r) { return r % 3 == 1 ? 0 : most * (r + 1); };
    std::vector<std::int64_t> mine, expected;
    for (Rank r = 0; r < world.size(); ++r) {
      for (std::int64_t i = 0; i < count_of(r); ++i) expected.push_back(1'000'000'000LL * r + i);
    }
    for (std::int64_t i = 0; i < count_of(world.rank()); ++i)
      mine.push_back(1'000'000'000LL * world.rank() + i);
    const auto all = NodeArray<std::int64_t>::gathered(world, mine);
    ASSERT_EQ(all.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_EQ(all[i], expected[i]);
    if (most == 100'000) {
      EXPECT_EQ(lies_in_shared_memory(all.data()), world.size() > 1);
    }
  }
}

TEST(NodeArrayTest, IsLetGoByRanksOneByOne) {
  const Communicator world = Communicator::world();
  for (Rank first = 0; first < world.size(); ++first) {
    NodeArray<std::int64_t> shared(world, squares(5000));
    if (world.rank() == first) shared = {};
    world.barrier();
    const NodeArray<std::int64_t> copy = std::exchange(shared, {});
    EXPECT_EQ(copy.size(), world.rank() == first ? 0u : 5000u);
    if (copy.size() > 0) {
      EXPECT_EQ(copy[4999], 4999 * 4999);
    }
  }
}

TEST(NodeArrayTest, OfOneRankNeedsNoOthers) {
  if (Communicator::world().rank() > 0) return;
  const NodeArray<std::int64_t> alone(Communicator::self(), squares(10));
  EXPECT_EQ(alone[9], 81);
}

}  // namespace
}  // namespace aeroloom::parallel
