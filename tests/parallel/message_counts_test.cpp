#include "parallel/communication/message_counts.hpp"

#include "parallel/communication/neighbour_exchange.hpp"
#include "parallel/observation/timers.hpp"

#include <functional>
#include <map>
#include <ostream>
#include <vector>

#include <gtest/gtest.h>

namespace aeroloom::parallel {

void PrintTo(const MessageCounts& counts, std::ostream* out) {
  for (const Messages& messages : {counts.collective, counts.neighbour, counts.rendezvous})
    *out << messages.count << " messages of " << messages.bytes << " bytes; ";
}

namespace {

MessageCounts sent_by(const std::function<void()>& work) {
  MessageCounts sent;
  sent -= message_counts();
  work();
  sent += message_counts();
  return sent;
}

class MessageCountsTest : public testing::Test {
protected:
  /// Nothing on one rank.
  MessageCounts expected(Messages MessageCounts::*kind, const Messages& on_several) const {
    MessageCounts counts;
    if (size > 1) counts.*kind = on_several;
    return counts;
  }
  MessageCounts collective(std::int64_t count, std::int64_t bytes) const {
    return expected(&MessageCounts::collective, {count, bytes});
  }
  std::int64_t sum_of_bytes(const Messages& mine) const { return world.sum(mine.bytes); }

  const Communicator world = Communicator::world();
  const Rank rank = world.rank();
  const int size = world.size();
};

TEST_F(MessageCountsTest, BarriersHaveNoBytes) {
  EXPECT_EQ(sent_by([&] { world.barrier(); }), collective(1, 0));
}

TEST_F(MessageCountsTest, BroadcastsReachEachOtherRankOnce) {
  for (Rank root = 0; root < size; ++root) {
    const MessageCounts sent = sent_by([&] {
      Bytes bytes(rank == root ? 1000 : 0);
      world.broadcast(bytes, root);
    });
    EXPECT_EQ(sent, collective(2, (rank + 1) % size == root ? 0 : 8 + 1000));
    EXPECT_EQ(sum_of_bytes(sent.collective), (size - 1) * (8 + 1000));
  }
}

TEST_F(MessageCountsTest, LongBroadcastsAreSeveral) {
  constexpr std::int64_t length = (std::int64_t{1} << 26) + 5;
  const MessageCounts sent = sent_by([&] {
    Bytes bytes(static_cast<std::size_t>(rank == 0 ? length : 0));
    world.broadcast(bytes);
  });
  EXPECT_EQ(sent, collective(3, rank + 1 == size ? 0 : 8 + length));
}

TEST_F(MessageCountsTest, AllGathersGoRoundARing) {
  const MessageCounts sent = sent_by([&] { world.all_gather(Bytes(static_cast<std::size_t>(100 + rank))); });
  const std::int64_t all = 100 * size + size * (size - 1) / 2, of_next = 100 + (rank + 1) % size;
  EXPECT_EQ(sent, collective(2, 8 * (size - 1) + all - of_next));
  EXPECT_EQ(sum_of_bytes(sent.collective), (size - 1) * (8 * size + all));
}

TEST_F(MessageCountsTest, GatheredBytesGoToTheRoot) {
  const Rank root = size - 1;
  const MessageCounts sent =
      sent_by([&] { world.gather(Bytes(static_cast<std::size_t>(100 + rank)), root); });
  EXPECT_EQ(sent, rank == root ? collective(1, 0) : collective(2, 8 + 100 + rank));
}

TEST_F(MessageCountsTest, ReductionsDoubleTheDistance) {
  const std::map<int, std::vector<std::int64_t>> values = {
      {1, {0}}, {2, {1, 1}}, {3, {1, 2, 1}}, {4, {2, 2, 2, 2}}, {5, {1, 3, 2, 2, 2}}};
  const std::int64_t expected_values = values.at(size)[static_cast<std::size_t>(rank)];
  EXPECT_EQ(sent_by([&] { world.sum(std::int64_t{rank}); }), collective(1, 8 * expected_values));
  EXPECT_EQ(sent_by([&] { world.maximum(0.5 * rank); }), collective(1, 8 * expected_values));
  EXPECT_EQ(sent_by([&] { world.exclusive_scan(rank); }), collective(1, rank + 1 == size ? 0 : 8));
}

TEST_F(MessageCountsTest, ExchangesAnnounceWhatTheySend) {
  const MessageCounts sent = sent_by([&] {
    std::vector<Parcel> parcels;
    // What a rank sends itself costs nothing.
    for (Rank to = 0; to <= rank; ++to) parcels.push_back({to, Bytes(static_cast<std::size_t>(50 + to))});
    world.exchange(std::move(parcels));
  });
  const std::int64_t contents = 50 * rank + rank * (rank - 1) / 2;
  EXPECT_EQ(sent, expected(&MessageCounts::rendezvous, {1 + 2 * rank, 8 * rank + contents}));
}

TEST_F(MessageCountsTest, NeighboursSendTheirItems) {
  const Rank next = (rank + 1) % size, last = (rank + size - 1) % size;
  std::vector<PartnerItems> sends, receives;
  if (size > 1) {
    sends = {{next, static_cast<std::size_t>(rank + 1)}};
    receives = {{last, static_cast<std::size_t>(last + 1)}};
  }
  const NeighbourExchange exchange(world, sends, receives);
  const std::vector<std::int64_t> out(size > 1 ? rank + 1 : 0);
  std::vector<std::int64_t> in(size > 1 ? last + 1 : 0);
  const MessageCounts sent = sent_by([&] {
    for (int round = 0; round < 3; ++round)
      exchange.exchange(std::span<const std::int64_t>(out), std::span<std::int64_t>(in));
  });
  EXPECT_EQ(sent, expected(&MessageCounts::neighbour, {3, 3 * 8 * (rank + 1)}));
}

TEST_F(MessageCountsTest, GroupsOfOneSendNothing) {
  const Communicator self = Communicator::self();
  const MessageCounts sent = sent_by([&] {
    self.barrier();
    self.all_gather(Bytes(10));
    self.sum(std::int64_t{1});
    self.exchange({{0, Bytes(10)}});
  });
  EXPECT_EQ(sent, MessageCounts());
}

TEST_F(MessageCountsTest, StagesHaveTheirOwn) {
  StageClock clock;
  const auto broadcast = [&](std::size_t length) {
    Bytes bytes(length);
    world.broadcast(bytes);
  };
  clock.begin("surface");
  broadcast(100);
  clock.end();
  broadcast(7);
  clock.begin("volume");
  world.exchange({{(rank + 1) % size, Bytes(static_cast<std::size_t>(rank))}});
  clock.end();
  clock.begin("surface");
  broadcast(1000);
  clock.end();
  const std::int64_t bytes = 2 * 8 + 1100;
  EXPECT_EQ(clock.costs()[0].messages, collective(4, rank + 1 == size ? 0 : bytes));

  const std::vector<StageSummary> summaries = clock.summarise(world);
  const MessageSummary& collective = summaries[0].collective;
  EXPECT_EQ(collective.count, size > 1 ? 4 * size : 0);
  EXPECT_EQ(collective.count_max, size > 1 ? 4 : 0);
  EXPECT_EQ(collective.bytes, (size - 1) * bytes);
  EXPECT_EQ(collective.bytes_max, size > 1 ? bytes : 0);
  const MessageSummary& rendezvous = summaries[1].rendezvous;
  EXPECT_EQ(summaries[1].collective.count, 0);
  EXPECT_EQ(rendezvous.count,
            size > 1 ? 3 * size - 1 : 0);  // rank 0 has nothing to send but the announcement
  EXPECT_EQ(rendezvous.count_max, size > 1 ? 3 : 0);
  EXPECT_EQ(rendezvous.bytes, size > 1 ? 8 * size + size * (size - 1) / 2 : 0);
  EXPECT_EQ(rendezvous.bytes_max, size > 1 ? 8 + size - 1 : 0);
}

}  // namespace
}  // namespace aeroloom::parallel
