#include "parallel/schedule.hpp"

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

TEST(ScheduleTest, GivesTheLargestFirst) {
  EXPECT_EQ(assign_largest_first(std::vector<double>{1, 5, 3, 3}, 2), (std::vector<Rank>{0, 0, 1, 1}));
}

TEST(ScheduleTest, BreaksTiesByTaskAndRank) {
  EXPECT_EQ(assign_largest_first(std::vector<double>{2, 2, 2, 2, 2}, 3), (std::vector<Rank>{0, 1, 2, 0, 1}));
  EXPECT_EQ(assign_largest_first(std::vector<double>{0, 0}, 3), (std::vector<Rank>{0, 0}));
}

TEST(ScheduleTest, CopesWithFewTasksAndNone) {
  EXPECT_TRUE(assign_largest_first({}, 4).empty());
  EXPECT_EQ(assign_largest_first(std::vector<double>{1}, 4), (std::vector<Rank>{0}));
  EXPECT_TRUE(tasks_of_rank({}, {}, 0).empty());
}

TEST(ScheduleTest, StaysWithinGrahamsBound) {
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

TEST(ScheduleTest, TasksOfRanksPartitionAllTasksLargestFirst) {
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
}

}  // namespace
}  // namespace aeroloom::parallel
