#include "parallel/communication/node_array.hpp"

#include "parallel/communication/imposed_nodes.hpp"
#include "tests/several_ranks.hpp"

#include <cstdint>
#include <fstream>
#include <span>
#include <sstream>
#include <stdexcept>
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

TEST(NodeArrayTest, IsComposedOfWhatNodesWriteThemselves) {
  const Communicator world = Communicator::world();
  for (const int ranks_per_node : {1, 2, 100}) {
    const Communicator ranks = impose_nodes(world, ranks_per_node);
    const auto node_of = [&](Rank r) { return r / ranks_per_node; };
    const auto count_of = [](Rank r) { return r % 3 == 1 ? std::size_t{0} : std::size_t{1000} * (r + 1); };
    const auto item = [](Rank r, std::size_t i) { return 1'000'000LL * r + static_cast<std::int64_t>(i); };
    std::vector<std::int64_t> mine;
    for (std::size_t i = 0; i < count_of(ranks.rank()); ++i) mine.push_back(item(ranks.rank(), i));
    const auto write = [&](Rank rank, std::size_t first, std::span<std::int64_t> to) {
      EXPECT_NE(node_of(rank), node_of(ranks.rank()));
      std::size_t before = 0;
      for (Rank r = 0; r < rank; ++r) before += count_of(r);
      EXPECT_EQ(first, before);
      EXPECT_EQ(to.size(), count_of(rank));
      for (std::size_t i = 0; i < to.size(); ++i) to[i] = item(rank, i);
    };
    const auto all = NodeArray<std::int64_t>::composed(ranks, mine, write);
    std::size_t next = 0;
    for (Rank r = 0; r < ranks.size(); ++r) {
      for (std::size_t i = 0; i < count_of(r); ++i) ASSERT_EQ(all[next++], item(r, i));
    }
    EXPECT_EQ(all.size(), next);
  }
}

TEST(NodeArrayTest, AllLearnThatOneCouldNotWrite) {
  NEEDS_SEVERAL_RANKS();
  const Communicator ranks = impose_nodes(Communicator::world(), 1);
  const auto fail = [&](Rank, std::size_t, std::span<std::int64_t>) {
    if (ranks.rank() == 0) throw std::runtime_error("no");
  };
  EXPECT_THROW(NodeArray<std::int64_t>::composed(ranks, squares(3), fail), CollectiveError);
}

TEST(NodeArrayTest, GathersFromNodeToNode) {
  const Communicator ranks = impose_nodes(Communicator::world(), 2);
  const auto all = NodeArray<std::int64_t>::gathered(ranks, {ranks.rank(), -1});
  for (Rank r = 0; r < ranks.size(); ++r) {
    EXPECT_EQ(all[2 * static_cast<std::size_t>(r)], r);
    EXPECT_EQ(all[2 * static_cast<std::size_t>(r) + 1], -1);
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

TEST(NodeArrayLocal, OfOneRankNeedsNoOthers) {
  if (Communicator::world().rank() > 0) return;
  const NodeArray<std::int64_t> alone(Communicator::self(), squares(10));
  EXPECT_EQ(alone[9], 81);
}

}  // namespace
}  // namespace aeroloom::parallel
