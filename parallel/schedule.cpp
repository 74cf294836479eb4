#include "parallel/schedule.hpp"

#include <algorithm>
#include <numeric>
#include <queue>

namespace aeroloom::parallel {

namespace {

/// Orders tasks largest load first, ties to the lower task.
void sort_largest_first(std::vector<int>& tasks, std::span<const double> loads) {
  std::sort(tasks.begin(), tasks.end(), [&](int a, int b) {
    const double load_a = loads[static_cast<std::size_t>(a)], load_b = loads[static_cast<std::size_t>(b)];
    return load_a != load_b ? load_a > load_b : a < b;
  });
}

struct Burden {
  double load;
  Rank rank;
  friend bool operator>(const Burden& a, const Burden& b) {
    return a.load != b.load ? a.load > b.load : a.rank > b.rank;
  }
};

}  // namespace

std::vector<Rank> assign_largest_first(std::span<const double> loads, int ranks) {
  std::vector<int> order(loads.size());
  std::iota(order.begin(), order.end(), 0);
  sort_largest_first(order, loads);
  std::priority_queue<Burden, std::vector<Burden>, std::greater<>> least_burdened;
  for (Rank r = 0; r < ranks; ++r) least_burdened.push({0, r});
  std::vector<Rank> assignment(loads.size());
  for (const int task : order) {
    Burden burden = least_burdened.top();
    least_burdened.pop();
    assignment[static_cast<std::size_t>(task)] = burden.rank;
    burden.load += loads[static_cast<std::size_t>(task)];
    least_burdened.push(burden);
  }
  return assignment;
}

std::vector<int> tasks_of_rank(std::span<const Rank> assignment, std::span<const double> loads, Rank rank) {
  std::vector<int> tasks;
  for (std::size_t t = 0; t < assignment.size(); ++t) {
    if (assignment[t] == rank) tasks.push_back(static_cast<int>(t));
  }
  sort_largest_first(tasks, loads);
  return tasks;
}

}  // namespace aeroloom::parallel
