#include "parallel/communication/schedule.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace aeroloom::parallel {
namespace {

std::vector<double> burdens(const std::vector<Rank>& assignment, const std::vector<double>& loads,
                            int ranks) {
  std::vector<double> burden(static_cast<std::size_t>(ranks), 0.0);
  for (std::size_t t = 0; t < loads.size(); ++t) burden[static_cast<std::size_t>(assignment[t])] += loads[t];
  return burden;
}

TEST(ScheduleLocal, GivesTheLargestFirst) {
  EXPECT_EQ(assign_largest_first(std::vector<double>{1, 5, 3, 3}, 2), (std::vector<Rank>{0, 0, 1, 1}));
}

TEST(ScheduleLocal, BreaksTiesByTaskAndRank) {
  EXPECT_EQ(assign_largest_first(std::vector<double>{2, 2, 2, 2, 2}, 3), (std::vector<Rank>{0, 1, 2, 0, 1}));
  EXPECT_EQ(assign_largest_first(std::vector<double>{0, 0}, 3), (std::vector<Rank>{0, 0}));
}

TEST(ScheduleLocal, CopesWithFewTasksAndNone) {
  EXPECT_TRUE(assign_largest_first({}, 4).empty());
  EXPECT_EQ(assign_largest_first(std::vector<double>{1}, 4), (std::vector<Rank>{0}));
  EXPECT_TRUE(tasks_of_rank({}, {}, 0).empty());
}

TEST(ScheduleLocal, TakesIntoAccountWhatRanksHaveDone) {
  const std::vector<double> loads{3, 2, 2}, done{4, 0};
  EXPECT_EQ(assign_largest_first(loads, done), (std::vector<Rank>{1, 1, 0}));
}

TEST(ScheduleLocal, StaysWithinGrahamsBound) {
  std::mt19937 random(3);
  for (const int ranks : {1, 2, 3, 7, 64}) {
    std::vector<double> loads(200);
    for (double& load : loads) load = 1 + random() % 1000;
    const auto burden = burdens(assign_largest_first(loads, ranks), loads, ranks);
    // Largest first is within 4/3 of the optimum, which is at least the mean and the largest task.
    const double mean = std::accumulate(loads.begin(), loads.end(), 0.0) / ranks;
    const double optimum = std::max(mean, *std::max_element(loads.begin(), loads.end()));
    EXPECT_LE(*std::max_element(burden.begin(), burden.end()), optimum * 4 / 3);
  }
}

TEST(ScheduleLocal, RunsKeepTheOrderAndAreAsEvenAsItAllows) {
  EXPECT_EQ(assign_in_order(std::vector<double>{1, 1, 1, 1, 4}, 2), (std::vector<Rank>{0, 0, 0, 0, 1}));
  EXPECT_EQ(assign_in_order(std::vector<double>{3, 1, 2, 2, 1, 3}, 3), (std::vector<Rank>{0, 0, 1, 1, 2, 2}));
  EXPECT_EQ(assign_in_order(std::vector<double>{5, 0, 0}, 4), (std::vector<Rank>{0, 1, 1}));
  EXPECT_TRUE(assign_in_order({}, 4).empty());
  // One large task does not set the bound of the others.
  EXPECT_EQ(assign_in_order(std::vector<double>{6, 1, 1, 1, 1, 1, 1}, 4),
            (std::vector<Rank>{0, 1, 1, 2, 2, 3, 3}));
  std::vector<double> loads;
  for (int i = 0; i < 200; ++i) loads.push_back(1 + i * i % 7);
  for (const int ranks : {1, 2, 7, 64, 200, 300}) {
    const std::vector<Rank> assignment = assign_in_order(loads, ranks);
    ASSERT_EQ(assignment.size(), loads.size());
    EXPECT_TRUE(std::is_sorted(assignment.begin(), assignment.end()));
    EXPECT_LT(assignment.back(), ranks);
    const double mean = std::accumulate(loads.begin(), loads.end(), 0.0) / ranks;
    EXPECT_LT(heaviest(loads, assignment, ranks), mean + 7 + 1e-9);
  }
}

TEST(ScheduleLocal, MovesNoMoreThanTheExcess) {
  const std::vector<double> loads{4, 3, 2, 1, 1, 1};
  EXPECT_EQ(move_excess(loads, std::vector<Rank>{0, 0, 0, 1, 1, 1}, 2),
            (std::vector<Rank>{0, 1, 0, 1, 1, 1}));
  // What is even stays.
  const std::vector<Rank> even{1, 0, 1, 0, 0, 0};
  EXPECT_EQ(move_excess(loads, even, 2), even);
  EXPECT_TRUE(move_excess({}, {}, 4).empty());
  EXPECT_EQ(move_excess(std::vector<double>{1}, std::vector<Rank>{2}, 3), (std::vector<Rank>{0}));
}

TEST(ScheduleLocal, MovedTasksEvenOutTheLoad) {
  std::mt19937 random(5);
  for (const int ranks : {1, 2, 3, 7, 64}) {
    std::vector<double> loads(200);
    std::vector<Rank> now(loads.size());
    for (double& load : loads) load = 1 + random() % 1000;
    for (Rank& rank : now) rank = static_cast<Rank>(random() % static_cast<unsigned>(ranks));
    const auto burden = burdens(move_excess(loads, now, ranks), loads, ranks);
    const double mean = std::accumulate(loads.begin(), loads.end(), 0.0) / ranks;
    // No rank that has the mean already gets anything.
    EXPECT_LE(*std::max_element(burden.begin(), burden.end()),
              mean + *std::max_element(loads.begin(), loads.end()));
  }
}

TEST(ScheduleLocal, SharesGoWhereMostOfThemIs) {
  const std::vector<double> loads{4, 3, 2, 1, 1, 1};
  const std::vector<Rank> shares{0, 1, 1, 0, 2, 2};
  // Share 0 has 4 on rank 2, share 1 has 5 on rank 0; share 2, of which nothing is there, gets what is left.
  EXPECT_EQ(keep_in_place(loads, shares, std::vector<Rank>{2, 0, 0, 1, 0, 2}, 3),
            (std::vector<Rank>{2, 0, 0, 2, 1, 1}));
  EXPECT_EQ(keep_in_place(loads, shares, shares, 3), shares);
  EXPECT_TRUE(keep_in_place({}, {}, {}, 4).empty());
}

TEST(ScheduleLocal, MovesTasksOnlyWhereThatPays) {
  const std::vector<Rank> even{0, 0, 1, 1}, uneven{0, 0, 0, 1}, worst{0, 0, 0, 0};
  EXPECT_EQ(rebalance(std::vector<double>{1, 1, 1, 1}, even, 2), even);
  EXPECT_EQ(rebalance(std::vector<double>{1, 1, 1.04, 1.04}, even, 2), even);  // within five per cent
  EXPECT_EQ(rebalance(std::vector<double>{5, 1, 1, 1}, uneven, 2), (std::vector<Rank>{0, 1, 1, 1}));
  EXPECT_EQ(rebalance(std::vector<double>{9, 0, 0, 0}, worst, 2), worst);  // one task is no less anywhere
  EXPECT_DOUBLE_EQ(heaviest(std::vector<double>{5, 1, 1, 1}, uneven, 2), 7);
  EXPECT_TRUE(rebalance({}, {}, 3).empty());
}

TEST(ScheduleLocal, BatchesFollowTheOrderOfEachRank) {
  const std::vector<double> loads{1, 5, 3, 3, 4, 2, 7};
  const std::vector<Rank> assignment{0, 0, 0, 0, 0, 1, 1};
  const std::vector<int> batches = batches_of_tasks(assignment, loads, 2);
  EXPECT_EQ(batches, (std::vector<int>{2, 0, 1, 1, 0, 0, 0}));
  for (const Rank r : {0, 1}) {
    const std::vector<int> tasks = tasks_of_rank(assignment, loads, r);
    for (std::size_t i = 0; i < tasks.size(); ++i)
      EXPECT_EQ(batches[static_cast<std::size_t>(tasks[i])], static_cast<int>(i) / 2);
  }
  EXPECT_TRUE(batches_of_tasks({}, {}, 4).empty());
}

TEST(ScheduleLocal, TasksOfRanksPartitionAllTasksLargestFirst) {
  const std::vector<double> loads{4, 9, 4, 1, 7, 4, 2};
  const auto assignment = assign_largest_first(loads, 3);
  std::vector<int> all;
  for (Rank r = 0; r < 3; ++r) {
    const auto tasks = tasks_of_rank(assignment, loads, r);
    for (std::size_t i = 1; i < tasks.size(); ++i) {
      const double before = loads[static_cast<std::size_t>(tasks[i - 1])],
                   now = loads[static_cast<std::size_t>(tasks[i])];
      EXPECT_TRUE(before > now || (before == now && tasks[i - 1] < tasks[i]));
    }
    all.insert(all.end(), tasks.begin(), tasks.end());
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(all, (std::vector<int>{0, 1, 2, 3, 4, 5, 6}));
}

TEST(ScheduleTest, IsTheSameOnEveryRank) {
  std::mt19937 random(11);
  std::vector<double> loads(500);
  for (double& load : loads) load = random() % 50;  // many ties
  const auto world = Communicator::world();
  const auto mine = assign_largest_first(loads, 7);
  auto of_root = mine;
  world.broadcast_items(of_root);
  EXPECT_EQ(mine, of_root);
  std::vector<Rank> now(loads.size());
  for (Rank& rank : now) rank = static_cast<Rank>(random() % 7);
  const auto moved = move_excess(loads, now, 7);
  of_root = moved;
  world.broadcast_items(of_root);
  EXPECT_EQ(moved, of_root);
}

}  // namespace
}  // namespace aeroloom::parallel
