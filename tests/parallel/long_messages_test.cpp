/// Messages longer than MPI is given at once. They take seconds on more ranks than cores.
#include "tests/parallel/letter.hpp"

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

class LongMessages : public testing::Test {
protected:
  const Communicator world = Communicator::world();
  const Rank rank = world.rank();
  const int size = world.size();
};

TEST_F(LongMessages, MoveInSeveralParts) {
  const std::size_t length = 70'000'001;  // no whole number of parts
  const Rank next = (rank + 1) % size, previous = (rank + size - 1) % size;
  std::vector<Parcel> outgoing;
  outgoing.push_back({next, letter(rank, next, length)});
  const auto incoming = world.exchange(std::move(outgoing));
  ASSERT_EQ(incoming.size(), 1u);
  EXPECT_TRUE(incoming[0].content == letter(previous, rank, length));
  Bytes bytes = rank == size - 1 ? letter(rank, 0, length) : Bytes{};
  world.broadcast(bytes, size - 1);
  EXPECT_TRUE(bytes == letter(size - 1, 0, length));
}

TEST_F(LongMessages, AreGatheredInSeveralParts) {
  const auto length = [](Rank r) {
    return r == 0 ? std::size_t{70'000'003} : static_cast<std::size_t>(r) * 5'000'001;
  };
  const auto all = world.all_gather(letter(rank, 0, length(rank)));
  for (Rank r = 0; r < size; ++r) EXPECT_TRUE(all[static_cast<std::size_t>(r)] == letter(r, 0, length(r)));
  const auto parts = world.gather(letter(rank, 1, length(rank)), size - 1);
  for (std::size_t r = 0; r < parts.size(); ++r) {
    EXPECT_TRUE(parts[r] == letter(static_cast<Rank>(r), 1, length(static_cast<Rank>(r))));
  }
}

}  // namespace
}  // namespace aeroloom::parallel
