#include "parallel/observation/timers.hpp"

#include "tests/several_ranks.hpp"

#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

namespace aeroloom::parallel {
namespace {

void work(double seconds) {
  const double start = cpu_seconds();
  while (cpu_seconds() - start < seconds) {
  }
}

TEST(TimersLocal, CpuTimeDoesNotRunWhileSleeping) {
  const double cpu = cpu_seconds(), wall = wall_seconds();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_GE(wall_seconds() - wall, 0.1);
  EXPECT_LT(cpu_seconds() - cpu, (wall_seconds() - wall) / 2);
}

constexpr std::size_t hundred_megabytes = 100'000'000;

/// Uses memory and gives it back to the system, whatever the allocator keeps.
void use_memory(std::size_t size) {
  void* memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
  std::memset(memory, 1, size);
  munmap(memory, size);
}

TEST(TimersLocal, PeakMemoryRemembersWhatWasFreed) {
  const std::int64_t before = resident_bytes();
  use_memory(hundred_megabytes);
  EXPECT_GE(peak_resident_bytes(), before + 95'000'000);
  EXPECT_LT(resident_bytes(), peak_resident_bytes() - 90'000'000);
}

TEST(StageClockLocal, PeaksAreThoseOfTheStage) {
  if (access("/proc/self/clear_refs", W_OK) != 0)
    GTEST_SKIP() << "the system keeps one peak for the whole run";
  StageClock clock;
  clock.begin("large");
  use_memory(hundred_megabytes);
  clock.end();
  clock.begin("small");
  clock.end();
  EXPECT_LT(clock.costs()[1].peak_resident_bytes, clock.costs()[0].peak_resident_bytes - 90'000'000);
  EXPECT_GE(peak_resident_bytes(), clock.costs()[0].peak_resident_bytes);
}

TEST(StageClockLocal, TellsOwnMemoryFromShared) {
  constexpr auto size = static_cast<std::int64_t>(hundred_megabytes);
  const std::vector<char> mine(hundred_megabytes, 1);
  void* shared = mmap(nullptr, hundred_megabytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(shared, MAP_FAILED);
  std::memset(shared, 1, hundred_megabytes);
  int ready[2], done[2];
  ASSERT_EQ(pipe(ready) + pipe(done), 0);
  const pid_t other = fork();
  if (other == 0) {
    long sum = 0;
    for (std::size_t i = 0; i < hundred_megabytes; i += 4096) sum += static_cast<const char*>(shared)[i];
    char go = static_cast<char>(sum);
    const bool told = write(ready[1], &go, 1) == 1 && read(done[0], &go, 1) == 1;
    _exit(told ? 0 : 1);
  }
  char byte = 0;
  ASSERT_EQ(read(ready[0], &byte, 1), 1);
  StageClock clock;
  clock.begin("both");
  clock.end();
  const StageCost& cost = clock.costs()[0];
  EXPECT_GE(cost.peak_own_bytes, size);
  EXPECT_LT(cost.peak_own_bytes, cost.peak_resident_bytes - size / 3);  // half of what two processes have
  ASSERT_EQ(write(done[1], &byte, 1), 1);
  waitpid(other, nullptr, 0);
  munmap(shared, hundred_megabytes);
}

TEST(StageClockLocal, AddsToTheOpenStageOnly) {
  StageClock clock;
  clock.add_task_cpu(5);  // before any stage: nobody's
  clock.begin("surface");
  clock.add_pieces(3);
  {
    const ScopedCpu scope(ScopedCpu::As::task);
    work(0.05);
  }
  {
    const ScopedCpu scope(ScopedCpu::As::serial);
    work(0.02);
  }
  clock.end();
  clock.add_pieces(100);
  ASSERT_EQ(clock.costs().size(), 1u);
  const StageCost& cost = clock.costs()[0];
  EXPECT_EQ(cost.name, "surface");
  EXPECT_EQ(cost.pieces, 3);
  EXPECT_GE(cost.task_cpu_seconds, 0.07);
  EXPECT_GE(cost.serial_cpu_seconds, 0.02);
  EXPECT_LT(cost.serial_cpu_seconds, cost.task_cpu_seconds);
  EXPECT_GE(cost.wall_seconds, cost.task_cpu_seconds * 0.99);
  EXPECT_GT(cost.peak_resident_bytes, 0);
}

TEST(StageClockTest, TellsTasksChecksMessagesAndTheRestApart) {
  const auto world = Communicator::world();
  StageClock clock;
  double between = 0;
  const double before = cpu_seconds();
  clock.begin("volume");
  {
    const ScopedCpu task(ScopedCpu::As::task);
    work(0.06);
    // What lies within is no task, and neither is waiting.
    const ScopedCpu check(ScopedCpu::As::check);
    work(0.02);
    // However late a rank comes to the first barrier, all but rank 0 wait at the second, less what a busy
    // machine makes of the time between them.
    world.barrier();
    const double after_first = wall_seconds();
    if (world.is_root()) std::this_thread::sleep_for(std::chrono::milliseconds(400));
    between = wall_seconds() - after_first;
    world.barrier();
  }
  work(0.04);
  clock.end();
  const double used = cpu_seconds() - before;
  const StageCost& cost = clock.costs()[0];
  // A busy machine may charge the loops more than they asked for, but no second is counted twice.
  EXPECT_GE(cost.task_cpu_seconds, 0.06);
  EXPECT_GE(cost.check_cpu_seconds, 0.02);
  EXPECT_GE(cost.other_cpu_seconds, 0.04);
  EXPECT_LE(cost.task_cpu_seconds + cost.check_cpu_seconds + cost.other_cpu_seconds, used);
  if (world.is_root())
    EXPECT_LT(cost.waiting_seconds, cost.wall_seconds - 0.4);
  else
    EXPECT_GT(cost.waiting_seconds, 0.2 - between);
}

TEST(StageClockLocal, NotesWhatWasBefore) {
  StageClock clock;
  const double noting = wall_seconds();
  clock.note("start", 2.5);
  EXPECT_GE(clock.costs()[0].wall_seconds, 2.5);
  EXPECT_LE(clock.costs()[0].wall_seconds, 2.5 + wall_seconds() - noting);
  EXPECT_GT(clock.costs()[0].other_cpu_seconds, 0);
  EXPECT_LE(clock.costs()[0].other_cpu_seconds, cpu_seconds());
  // The age has the clock ticks of the system. On a busy machine a sleep is as long as it likes, and so is
  // any step between two clocks: the age is read within what the other clock tells.
  const double start = wall_seconds();
  const double age = process_age_seconds();
  EXPECT_GT(age, 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const double least = process_age_seconds() - age;
  const double most = wall_seconds() - start;
  EXPECT_GT(least, 0.02);
  EXPECT_LT(least, most + 0.03);
}

TEST(StageClockLocal, GoesOnWithAStageBegunAgain) {
  StageClock clock;
  for (const char* name : {"decompose", "surface", "decompose"}) {
    clock.begin(name);
    clock.add_task_cpu(1.5);
    clock.end();
  }
  ASSERT_EQ(clock.costs().size(), 2u);
  EXPECT_EQ(clock.costs()[0].name, "decompose");
  EXPECT_EQ(clock.costs()[0].task_cpu_seconds, 3);
  EXPECT_EQ(clock.costs()[1].task_cpu_seconds, 1.5);
}

TEST(StageClockLocal, RefusesNestedStages) {
  StageClock clock;
  EXPECT_THROW(clock.end(), std::logic_error);
  clock.begin("a");
  EXPECT_THROW(clock.begin("b"), std::logic_error);
  StageClock other;
  EXPECT_THROW(other.begin("b"), std::logic_error);
  clock.end();
  EXPECT_NO_THROW(other.begin("b"));  // a clock that ends with a stage open leaves none behind
}

TEST(StageClockTest, IsTheClockOfItsThread) {
  begin_round();
  add_pieces(7);
  EXPECT_TRUE(noted_tasks().empty());
  StageClock clock;
  clock.begin("surface");
  add_pieces(2);
  add_task_cpu(1.5);
  add_serial_cpu(0.5);
  begin_round();
  note_task({.kind = TaskKind::face});
  EXPECT_EQ(noted_tasks().size(), 1u);
  std::thread([] {
    const ScopedCpu scope(ScopedCpu::As::task);
    add_pieces(100);
    work(0.02);
  }).join();
  clock.end();
  add_pieces(100);
  EXPECT_EQ(clock.costs()[0].pieces, 2);
  EXPECT_DOUBLE_EQ(clock.costs()[0].task_cpu_seconds, 1.5);
  EXPECT_DOUBLE_EQ(clock.costs()[0].serial_cpu_seconds, 0.5);
  ASSERT_EQ(clock.tasks().size(), 1u);
  EXPECT_EQ(clock.tasks()[0].round, 1);
}

TEST(StageClockLocal, CountsChildrenOnTopOfTheRank) {
  StageClock clock;
  clock.begin("volume");
  constexpr std::int64_t child = 1'000'000'000'000;
  clock.note_child_memory(child);
  clock.end();
  EXPECT_GT(clock.costs()[0].peak_resident_bytes, child);
}

TEST(StageClockTest, SummarisesOverRanks) {
  const auto world = Communicator::world();
  const int n = world.size();
  StageClock clock;
  for (const char* name : {"surface", "volume"}) {
    clock.begin(name);
    clock.add_task_cpu(1.0 + world.rank());
    clock.add_serial_cpu(0.5 * world.rank());
    clock.add_pieces(world.rank() + 1);
    clock.end();
  }
  const auto summaries = clock.summarise(world);
  ASSERT_EQ(summaries.size(), 2u);
  EXPECT_EQ(summaries[1].name, "volume");
  for (const StageSummary& summary : summaries) {
    EXPECT_DOUBLE_EQ(summary.cpu_seconds_min, 1.0);
    EXPECT_DOUBLE_EQ(summary.cpu_seconds_max, n);
    EXPECT_DOUBLE_EQ(summary.cpu_seconds_mean, (n + 1) / 2.0);
    ASSERT_EQ(summary.cpu_seconds_of_ranks.size(), static_cast<std::size_t>(world.size()));
    EXPECT_DOUBLE_EQ(summary.cpu_seconds_of_ranks.back(), n);
    EXPECT_DOUBLE_EQ(summary.serial_seconds, 0.5 * (n - 1));
    EXPECT_DOUBLE_EQ(summary.repeated_seconds, 0);
    EXPECT_EQ(summary.pieces, n * (n + 1) / 2);
    EXPECT_GE(summary.peak_resident_bytes_sum, summary.peak_resident_bytes_max);
    EXPECT_EQ(world.minimum(summary.wall_seconds), world.maximum(summary.wall_seconds));
  }
}

TEST(StageClockTest, SummarisesWhatWasToBeExchanged) {
  const auto world = Communicator::world();
  StageClock clock;
  clock.begin("volume");
  world.barrier();
  Bytes bytes(world.is_root() ? 1000 : 0);
  world.broadcast(bytes);
  world.all_gather(Bytes(static_cast<std::size_t>(10 + world.rank())));
  world.exchange({{world.rank(), Bytes(100)}});
  clock.end();
  const ExchangeCounts exchanges = clock.summarise(world)[0].exchanges;
  const std::int64_t n = world.size();
  EXPECT_EQ(exchanges.reduction, (Messages{1, 0}));
  EXPECT_EQ(exchanges.broadcast, (Messages{2, 8 + 1000}));
  EXPECT_EQ(exchanges.table, (Messages{1, 8}));
  EXPECT_EQ(exchanges.all_gather, (Messages{1, 10 * n + n * (n - 1) / 2}));
  EXPECT_EQ(exchanges.rendezvous, (Messages{1, 100 * n}));  // one call of each, the bytes of all
  EXPECT_EQ(exchanges.neighbour, Messages{});
}

TEST(StageClockLocal, TellsRepeatedWorkFromSerial) {
  StageClock clock;
  const double before = cpu_seconds();
  clock.begin("volume");
  {
    const ScopedCpu repeated(ScopedCpu::As::repeated);
    work(0.02);
  }
  {
    const ScopedCpu serial(ScopedCpu::As::serial);
    work(0.01);
  }
  clock.end();
  const double used = cpu_seconds() - before;
  const StageCost& cost = clock.costs()[0];
  EXPECT_GE(cost.repeated_cpu_seconds, 0.02);
  EXPECT_GE(cost.serial_cpu_seconds, cost.repeated_cpu_seconds + 0.01);
  EXPECT_LE(cost.serial_cpu_seconds, used);
  EXPECT_DOUBLE_EQ(cost.task_cpu_seconds, cost.serial_cpu_seconds);
}

TEST(StageClockLocal, NotesRoundsOfTasks) {
  StageClock clock;
  clock.begin_round();  // of no stage
  clock.begin("surface");
  clock.note_task({.kind = TaskKind::curve});
  clock.begin_round();
  clock.note_task({.kind = TaskKind::face});
  clock.end();
  clock.begin("volume");
  clock.begin_round();
  clock.note_task({.kind = TaskKind::zone});
  clock.end();
  ASSERT_EQ(clock.tasks().size(), 3u);
  EXPECT_EQ(clock.tasks()[0].round, 0);
  EXPECT_EQ(clock.tasks()[1].round, 1);
  EXPECT_EQ(clock.tasks()[2].round, 1);
}

TEST(StageClockTest, RefusesDifferentStagesOnEveryRank) {
  const auto world = Communicator::world();
  NEEDS_SEVERAL_RANKS();
  StageClock clock;
  clock.begin(world.is_root() ? "surface" : "volume");
  clock.end();
  EXPECT_THROW(clock.summarise(world), std::logic_error);
}

}  // namespace
}  // namespace aeroloom::parallel
