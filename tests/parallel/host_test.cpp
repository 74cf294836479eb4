/// The stages inside a program that runs MPI itself. Has its own main: no Environment is alive here.
#include "parallel/communication/host.hpp"

#include "parallel/communication/environment.hpp"
#include "parallel/sandbox/sandbox.hpp"

#include <algorithm>
#include <stdexcept>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

int rank_in_world() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  return rank;
}

/// Even and odd ranks of the world.
struct Half {
  MPI_Comm group = MPI_COMM_NULL;
  Half() { MPI_Comm_split(MPI_COMM_WORLD, rank_in_world() % 2, -rank_in_world(), &group); }
  ~Half() { MPI_Comm_free(&group); }
};

TEST(Host, ItsCommunicatorIsUsedAsItIs) {
  const Half half;
  const Communicator ranks = communicator_of(half.group);
  int size = 0, rank = 0;
  MPI_Comm_size(half.group, &size);
  MPI_Comm_rank(half.group, &rank);
  EXPECT_EQ(ranks.size(), size);
  EXPECT_EQ(ranks.rank(), rank);
  EXPECT_EQ(ranks.maximum(std::int64_t{rank_in_world()}) % 2, rank_in_world() % 2);
  const std::vector<int> mine{rank_in_world()};
  const std::vector<int> all = ranks.all_gather_items<int>(mine);
  EXPECT_TRUE(std::is_sorted(all.rbegin(), all.rend())) << "ranks run as the host numbered them";
}

TEST(Host, MessagesOfBothNeverMix) {
  const Half half;
  const Communicator ranks = communicator_of(half.group);
  const int next = (ranks.rank() + 1) % ranks.size(), last = (ranks.rank() + ranks.size() - 1) % ranks.size();
  int ours = 1000 + ranks.rank(), theirs = -1;
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Irecv(&theirs, 1, MPI_INT, MPI_ANY_SOURCE, MPI_ANY_TAG, half.group, &request);
  std::vector<Parcel> parcels{{next, to_bytes(std::span<const int>(&ours, 1))}};
  const std::vector<Parcel> arrived = ranks.exchange(std::move(parcels));
  ASSERT_EQ(arrived.size(), 1u);
  EXPECT_EQ(from_bytes<int>(arrived[0].content), std::vector<int>{1000 + last});
  const int word = 7;
  MPI_Send(&word, 1, MPI_INT, next, 1, half.group);
  MPI_Wait(&request, MPI_STATUS_IGNORE);
  EXPECT_EQ(theirs, 7) << "the host's receive for anything from anyone has not taken our message";
}

TEST(Host, ARankAloneNeedsNoEnvironmentButTheWorldDoes) {
  EXPECT_EQ(Communicator::self().size(), 1);
  EXPECT_THROW(Communicator::world(), std::logic_error);
  EXPECT_THROW(communicator_of(MPI_COMM_NULL), std::logic_error);
}

TEST(Host, AnEnvironmentUsesTheMpiThatRunsAndLeavesItRunning) {
  int argc = 0;
  char** argv = nullptr;
  {
    const Environment environment(argc, argv);
    EXPECT_FALSE(has_sandbox_server()) << "a rank that runs MPI must not fork";
    int size = 0;
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    EXPECT_EQ(Communicator::world().size(), size);
  }
  int ended = 1;
  MPI_Finalized(&ended);
  EXPECT_EQ(ended, 0);
}

Bytes reverse(std::span<const std::byte> input) {
  return {input.rbegin(), input.rend()};
}

Bytes refuse(std::span<const std::byte>) {
  throw std::runtime_error("bad facet");
}

TEST(Host, WithoutAServerTasksRunInTheRank) {
  register_sandbox_task("reverse", reverse);
  register_sandbox_task("refuse", refuse);
  const Bytes input{std::byte{1}, std::byte{2}};
  const SandboxResult good = run_sandboxed("reverse", input, {});
  EXPECT_EQ(good.status, SandboxStatus::ok);
  EXPECT_EQ(good.output, (Bytes{std::byte{2}, std::byte{1}}));
  const SandboxResult bad = run_sandboxed("refuse", input, {});
  EXPECT_EQ(bad.status, SandboxStatus::threw);
  EXPECT_EQ(bad.message, "bad facet");
  EXPECT_THROW(run_sandboxed("nobody", input, {}), std::logic_error);
}

}  // namespace
}  // namespace aeroloom::parallel

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  testing::InitGoogleTest(&argc, argv);
  int failed = RUN_ALL_TESTS(), any = 0;
  MPI_Allreduce(&failed, &any, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  MPI_Finalize();
  return any;
}
