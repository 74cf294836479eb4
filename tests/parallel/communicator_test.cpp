#include "tests/parallel/letter.hpp"

#include <cstdlib>
#include <numeric>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

TEST(Session, LooksForNoNetworkOnOneMachine) {
  if (std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr) GTEST_SKIP() << "not started by Open MPI";
  const char* const asked_for = std::getenv("OMPI_MCA_pml");
  ASSERT_NE(asked_for, nullptr);
  EXPECT_STREQ(asked_for, "ob1");
}

class CommunicatorTest : public testing::Test {
protected:
  const Communicator world = Communicator::world();
  const Rank rank = world.rank();
  const int size = world.size();
};

using CommunicatorLocal = CommunicatorTest;

TEST_F(CommunicatorLocal, SelfIsAlone) {
  const Communicator self = Communicator::self();
  EXPECT_EQ(self.rank(), 0);
  EXPECT_EQ(self.size(), 1);
  EXPECT_TRUE(self.is_root());
  EXPECT_EQ(self.sum(std::int64_t{5}), 5);
  const auto back = self.exchange({{0, letter(0, 0, 10)}});
  ASSERT_EQ(back.size(), 1u);
  EXPECT_EQ(back[0].content, letter(0, 0, 10));
}

TEST_F(CommunicatorTest, ReducesIntegers) {
  const std::int64_t large = std::int64_t{1} << 40;
  EXPECT_EQ(world.sum(large + rank), size * large + size * (size - 1) / 2);
  EXPECT_EQ(world.minimum(static_cast<std::int64_t>(rank) - 3), -3);
  EXPECT_EQ(world.maximum(static_cast<std::int64_t>(rank)), size - 1);
  EXPECT_EQ(world.exclusive_scan(std::int64_t{rank + 1}), static_cast<std::int64_t>(rank) * (rank + 1) / 2);
}

TEST_F(CommunicatorTest, ReducesReals) {
  EXPECT_EQ(world.minimum(1.5 + rank), 1.5);
  EXPECT_EQ(world.maximum(1.5 + rank), 0.5 + size);
  // Cancellation makes the order visible: it must be that of the ranks.
  const auto term = [](Rank r) { return r % 2 == 0 ? 1e16 + r : 1.0 / (r + 2); };
  double expected = 0;
  for (Rank r = 0; r < size; ++r) expected += term(r);
  EXPECT_EQ(world.sum(term(rank)), expected);
}

TEST_F(CommunicatorTest, ReducesManyAtOnce) {
  std::vector<std::int64_t> counts{rank, std::int64_t{1} << 40, -rank};
  world.sum_each(counts);
  const std::int64_t sum = static_cast<std::int64_t>(size) * (size - 1) / 2;
  EXPECT_EQ(counts, (std::vector<std::int64_t>{sum, size * (std::int64_t{1} << 40), -sum}));
  std::vector<double> sizes{1.5 + rank, 2.5 - rank};
  world.minimum_each(sizes);
  EXPECT_EQ(sizes, (std::vector<double>{1.5, 3.5 - size}));
  world.sum_each({});
}

TEST_F(CommunicatorTest, BroadcastsFromEveryRoot) {
  for (Rank root = 0; root < size; ++root) {
    Bytes bytes = rank == root ? letter(root, 0, 1000) : letter(rank, 1, 3);
    world.broadcast(bytes, root);
    EXPECT_EQ(bytes, letter(root, 0, 1000));
    std::vector<double> items;
    if (rank == root) items = {1.0, 2.0, static_cast<double>(root)};
    world.broadcast_items(items, root);
    EXPECT_EQ(items, (std::vector<double>{1.0, 2.0, static_cast<double>(root)}));
  }
  Bytes nothing;
  world.broadcast(nothing);
  EXPECT_TRUE(nothing.empty());
}

TEST_F(CommunicatorTest, GathersDifferentLengths) {
  const auto length = [](Rank r) { return static_cast<std::size_t>(r % 3) * 100; };  // some send nothing
  const auto all = world.all_gather(letter(rank, 0, length(rank)));
  ASSERT_EQ(all.size(), static_cast<std::size_t>(size));
  for (Rank r = 0; r < size; ++r) EXPECT_EQ(all[static_cast<std::size_t>(r)], letter(r, 0, length(r)));
  for (Rank root = 0; root < size; ++root) {
    const auto parts = world.gather(letter(rank, 0, length(rank)), root);
    if (rank != root) {
      EXPECT_TRUE(parts.empty());
      continue;
    }
    ASSERT_EQ(parts.size(), static_cast<std::size_t>(size));
    for (Rank r = 0; r < size; ++r) EXPECT_EQ(parts[static_cast<std::size_t>(r)], letter(r, 0, length(r)));
  }
}

TEST_F(CommunicatorTest, GathersItemsInRankOrder) {
  std::vector<std::int32_t> mine(static_cast<std::size_t>(rank) + 1, rank), expected;
  for (Rank r = 0; r < size; ++r) expected.insert(expected.end(), static_cast<std::size_t>(r) + 1, r);
  EXPECT_EQ(world.all_gather_items(std::span<const std::int32_t>(mine)), expected);
}

TEST_F(CommunicatorTest, ExchangesWithEverybodyInAscendingOrder) {
  std::vector<Parcel> outgoing;
  for (Rank to = size - 1; to >= 0; --to)
    outgoing.push_back({to, letter(rank, to, static_cast<std::size_t>(to) * 10)});
  const auto incoming = world.exchange(std::move(outgoing));
  ASSERT_EQ(incoming.size(), static_cast<std::size_t>(size));
  for (Rank from = 0; from < size; ++from) {
    const Parcel& parcel = incoming[static_cast<std::size_t>(from)];
    EXPECT_EQ(parcel.rank, from);
    EXPECT_EQ(parcel.content, letter(from, rank, static_cast<std::size_t>(rank * 10)));
  }
}

TEST_F(CommunicatorTest, ExchangesNothing) {
  EXPECT_TRUE(world.exchange({}).empty());
}

TEST_F(CommunicatorTest, ExchangesOneWay) {
  std::vector<Parcel> outgoing;
  if (rank == 0) outgoing.push_back({size - 1, letter(0, size - 1, 77)});
  const auto incoming = world.exchange(std::move(outgoing));
  if (rank != size - 1) {
    EXPECT_TRUE(incoming.empty());
    return;
  }
  ASSERT_EQ(incoming.size(), 1u);
  EXPECT_EQ(incoming[0].rank, 0);
  EXPECT_EQ(incoming[0].content, letter(0, size - 1, 77));
}

TEST_F(CommunicatorTest, ExchangesBackToBackDoNotMix) {
  // Random sparse patterns that every rank can foretell; ranks run ahead of each other freely.
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::size_t> lengths(static_cast<std::size_t>(size) *
                                     static_cast<std::size_t>(size));  // 0: no parcel, else length plus one
    for (auto& length : lengths) length = random() % 3 == 0 ? 1 + random() % 50 : 0;
    const auto length = [&](Rank from, Rank to) {
      return lengths[static_cast<std::size_t>(from) * static_cast<std::size_t>(size) +
                     static_cast<std::size_t>(to)];
    };
    std::vector<Parcel> outgoing;
    for (Rank to = 0; to < size; ++to) {
      if (length(rank, to)) outgoing.push_back({to, letter(rank + round, to, length(rank, to) - 1)});
    }
    const auto incoming = world.exchange(std::move(outgoing));
    std::size_t next = 0;
    for (Rank from = 0; from < size; ++from) {
      if (!length(from, rank)) continue;
      ASSERT_LT(next, incoming.size());
      EXPECT_EQ(incoming[next].rank, from);
      EXPECT_EQ(incoming[next].content, letter(from + round, rank, length(from, rank) - 1));
      ++next;
    }
    ASSERT_EQ(next, incoming.size());
  }
}

TEST_F(CommunicatorLocal, RefusesImpossibleParcels) {
  EXPECT_THROW(world.exchange({{size, {}}}), std::logic_error);
  EXPECT_THROW(world.exchange({{-1, {}}}), std::logic_error);
  EXPECT_THROW(world.exchange({{0, {}}, {0, {}}}), std::logic_error);
}

TEST(PackerLocal, ReadsBackWhatWasWritten) {
  Packer packer;
  packer.value(42);
  packer.text("wing");
  packer.array(std::vector<double>{1.5, -2.5});
  packer.array(std::vector<std::int64_t>{});
  packer.text("");
  packer.value('x');
  const Bytes bytes = packer.take();
  Unpacker unpacker(bytes);
  EXPECT_EQ(unpacker.value<int>(), 42);
  EXPECT_EQ(unpacker.text(), "wing");
  EXPECT_EQ(unpacker.array<double>(), (std::vector<double>{1.5, -2.5}));
  EXPECT_TRUE(unpacker.array<std::int64_t>().empty());
  EXPECT_EQ(unpacker.text(), "");
  EXPECT_FALSE(unpacker.at_end());
  EXPECT_EQ(unpacker.value<char>(), 'x');
  EXPECT_TRUE(unpacker.at_end());
  EXPECT_THROW(unpacker.value<char>(), std::logic_error);
}

TEST(PackerLocal, RefusesCountsPastTheEnd) {
  Packer packer;
  packer.value(std::uint64_t{1} << 62);
  const Bytes bytes = packer.take();
  EXPECT_THROW(Unpacker(bytes).array<double>(), std::logic_error);
  EXPECT_THROW(Unpacker(bytes).text(), std::logic_error);
}

TEST(PackerLocal, RefusesBrokenItems) {
  EXPECT_THROW(from_bytes<double>(Bytes(9)), std::logic_error);
  EXPECT_EQ(from_bytes<double>(Bytes(16)).size(), 2u);
}

}  // namespace
}  // namespace aeroloom::parallel
