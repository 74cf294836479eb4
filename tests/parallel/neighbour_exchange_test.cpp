#include "parallel/communication/neighbour_exchange.hpp"

#include <cstdint>
#include <stdexcept>
#include <tuple>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

/// Rank r sends r + s items to each other rank s, but none to the next one.
std::size_t items_between(Rank from, Rank to, int ranks) {
  return from == to || to == (from + 1) % ranks ? 0 : static_cast<std::size_t>(from + to);
}

struct Letter {
  std::int32_t from, to;
  std::int64_t place;
  static constexpr auto fields() { return std::tuple(&Letter::from, &Letter::to, &Letter::place); }
  friend bool operator==(const Letter&, const Letter&) = default;
};

std::vector<Letter> letters(Rank from, Rank to, int ranks) {
  std::vector<Letter> result;
  for (std::size_t i = 0; i < items_between(from, to, ranks); ++i)
    result.push_back({from, to, static_cast<std::int64_t>(i)});
  return result;
}

class NeighbourExchangeTest : public testing::Test {
protected:
  NeighbourExchangeTest() {
    for (Rank other = 0; other < world.size(); ++other) {
      const std::vector<Letter> mine = letters(world.rank(), other, world.size());
      const std::vector<Letter> theirs = letters(other, world.rank(), world.size());
      out.insert(out.end(), mine.begin(), mine.end());
      expected.insert(expected.end(), theirs.begin(), theirs.end());
      if (!mine.empty()) sends.push_back({other, mine.size()});
      if (!theirs.empty()) receives.push_back({other, theirs.size()});
    }
  }

  const Communicator world = Communicator::world();
  std::vector<PartnerItems> sends, receives;
  std::vector<Letter> out, expected;
};

TEST_F(NeighbourExchangeTest, ReceivesWhatOthersSentByPartner) {
  const NeighbourExchange exchange(world, sends, receives);
  for (int round = 0; round < 3; ++round) {
    std::vector<Letter> in(expected.size());
    exchange.exchange(std::span<const Letter>(out), std::span<Letter>(in));
    EXPECT_EQ(in, expected);
  }
}

TEST_F(NeighbourExchangeTest, GoesBackTheSameWay) {
  const NeighbourExchange back = NeighbourExchange(world, sends, receives).reversed();
  std::vector<Letter> in(out.size());
  back.exchange(std::span<const Letter>(expected), std::span<Letter>(in));
  EXPECT_EQ(in, out);
}

TEST_F(NeighbourExchangeTest, DoesNotMixWithOtherMessages) {
  const NeighbourExchange exchange(world, sends, receives);
  for (int round = 0; round < 5; ++round) {
    std::vector<Letter> in(expected.size());
    exchange.exchange(std::span<const Letter>(out), std::span<Letter>(in));
    EXPECT_EQ(in, expected);
    const auto arrived = world.exchange({{(world.rank() + 1) % world.size(), Bytes(5)}});
    ASSERT_EQ(arrived.size(), 1u);
    EXPECT_EQ(arrived[0].content.size(), 5u);
  }
}

// Longer than one part of a message.
TEST_F(NeighbourExchangeTest, SendsLongMessages) {
  if (world.size() != 2) GTEST_SKIP() << "for two ranks";
  constexpr std::size_t items = (std::size_t{1} << 23) + 5;  // of eight bytes
  std::vector<PartnerItems> to, from;
  std::vector<std::int64_t> numbers, in;
  (world.rank() == 0 ? to : from).push_back({1 - world.rank(), items});
  if (world.rank() == 0) {
    for (std::size_t i = 0; i < items; ++i) numbers.push_back(static_cast<std::int64_t>(3 * i));
  } else {
    in.resize(items);
  }
  const NeighbourExchange exchange(world, to, from);
  exchange.exchange(std::span<const std::int64_t>(numbers), std::span<std::int64_t>(in));
  for (std::size_t i = 0; i < in.size(); ++i) ASSERT_EQ(in[i], static_cast<std::int64_t>(3 * i));
}

TEST_F(NeighbourExchangeTest, RefusesWhatDoesNotFit) {
  EXPECT_THROW(NeighbourExchange(world, {{world.rank(), 1}}, {}), std::logic_error);
  EXPECT_THROW(NeighbourExchange(world, {{world.size(), 1}}, {}), std::logic_error);
  if (world.size() == 1) return;
  const Rank next = (world.rank() + 1) % world.size();
  EXPECT_THROW(NeighbourExchange(world, {{next, 1}, {next, 1}}, {}), std::logic_error);
  EXPECT_THROW(NeighbourExchange(world, {{next, 1}}, {}), std::logic_error);
  const NeighbourExchange exchange(world, sends, receives);
  const std::vector<std::byte> odd(8 * out.size() + 1);
  std::vector<std::byte> in(8 * expected.size() + 1);
  if (out.size() > 1 || expected.size() > 1) {
    EXPECT_THROW(exchange.exchange(odd, in), std::logic_error);
  }
}

}  // namespace
}  // namespace aeroloom::parallel
