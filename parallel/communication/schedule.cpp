#include "parallel/communication/schedule.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <queue>
#include <utility>

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

std::vector<int> largest_first(std::span<const double> loads) {
  std::vector<int> tasks(loads.size());
  std::iota(tasks.begin(), tasks.end(), 0);
  sort_largest_first(tasks, loads);
  return tasks;
}

/// Gives each task in turn to the rank with the least, beginning with these burdens.
void give_to_least_burdened(std::span<const int> tasks, std::span<const double> loads,
                            std::span<const double> burdens, std::vector<Rank>& assignment) {
  std::priority_queue<Burden, std::vector<Burden>, std::greater<>> least_burdened;
  for (std::size_t r = 0; r < burdens.size(); ++r) least_burdened.push({burdens[r], static_cast<Rank>(r)});
  for (const int task : tasks) {
    Burden burden = least_burdened.top();
    least_burdened.pop();
    assignment[static_cast<std::size_t>(task)] = burden.rank;
    burden.load += loads[static_cast<std::size_t>(task)];
    least_burdened.push(burden);
  }
}

/// Runs of tasks in their order that stay within `most` each, or have one task; as many as that takes.
std::vector<Rank> runs_within(std::span<const double> loads, double most) {
  std::vector<Rank> runs;
  Rank run = 0;
  double load = 0;
  for (const double task : loads) {
    if (load > 0 && load + task > most) ++run, load = 0;
    load += task;
    runs.push_back(run);
  }
  return runs;
}

}  // namespace

std::vector<Rank> assign_in_order(std::span<const double> loads, int ranks) {
  if (loads.empty()) return {};
  constexpr int halvings = 50;  // to rounding
  double too_little = 0, enough = std::accumulate(loads.begin(), loads.end(), 0.0);
  std::vector<Rank> best = runs_within(loads, enough);
  for (int i = 0; i < halvings; ++i) {
    const double most = 0.5 * (too_little + enough);
    std::vector<Rank> runs = runs_within(loads, most);
    const bool fits = runs.back() < ranks;
    (fits ? enough : too_little) = most;
    if (fits) best = std::move(runs);
  }
  return best;
}

std::vector<Rank> assign_largest_first(std::span<const double> loads, int ranks) {
  return assign_largest_first(loads, std::vector<double>(static_cast<std::size_t>(ranks), 0));
}

std::vector<Rank> assign_largest_first(std::span<const double> loads, std::span<const double> burdens) {
  std::vector<Rank> assignment(loads.size());
  give_to_least_burdened(largest_first(loads), loads, burdens, assignment);
  return assignment;
}

std::vector<Rank> move_excess(std::span<const double> loads, std::span<const Rank> now, int ranks) {
  const double mean = std::accumulate(loads.begin(), loads.end(), 0.0) / ranks;
  std::vector<Rank> assignment(now.begin(), now.end());
  std::vector<double> burdens(static_cast<std::size_t>(ranks), 0);
  std::vector<int> taken_away;
  for (const int task : largest_first(loads)) {
    const double load = loads[static_cast<std::size_t>(task)];
    double& burden = burdens[static_cast<std::size_t>(now[static_cast<std::size_t>(task)])];
    if (burden + load > mean)
      taken_away.push_back(task);
    else
      burden += load;
  }
  give_to_least_burdened(taken_away, loads, burdens, assignment);
  return assignment;
}

std::vector<Rank> keep_in_place(std::span<const double> loads, std::span<const Rank> shares,
                                std::span<const Rank> now, int ranks) {
  std::map<std::pair<Rank, Rank>, double> common;  // by share and rank
  for (std::size_t t = 0; t < loads.size(); ++t) common[{shares[t], now[t]}] += loads[t];
  std::vector<std::pair<std::pair<Rank, Rank>, double>> most_first(common.begin(), common.end());
  std::stable_sort(most_first.begin(), most_first.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  constexpr Rank none = -1;
  std::vector<Rank> rank_of(static_cast<std::size_t>(ranks), none), share_of(rank_of);
  const auto match = [&](Rank share, Rank rank) {
    Rank &its_rank = rank_of[static_cast<std::size_t>(share)],
         &its_share = share_of[static_cast<std::size_t>(rank)];
    if (its_rank == none && its_share == none) its_rank = rank, its_share = share;
  };
  for (const auto& [place, load] : most_first) match(place.first, place.second);
  Rank free = 0;
  for (Rank share = 0; share < ranks; ++share) {
    if (rank_of[static_cast<std::size_t>(share)] != none) continue;
    while (share_of[static_cast<std::size_t>(free)] != none) ++free;
    match(share, free);
  }
  std::vector<Rank> assignment;
  assignment.reserve(shares.size());
  for (const Rank share : shares) assignment.push_back(rank_of[static_cast<std::size_t>(share)]);
  return assignment;
}

double heaviest(std::span<const double> loads, std::span<const Rank> assignment, int ranks) {
  std::vector<double> burdens(static_cast<std::size_t>(ranks), 0);
  for (std::size_t t = 0; t < loads.size(); ++t) burdens[static_cast<std::size_t>(assignment[t])] += loads[t];
  return *std::max_element(burdens.begin(), burdens.end());
}

std::vector<Rank> rebalance(std::span<const double> loads, std::span<const Rank> now, int ranks) {
  constexpr double tolerance =
      1.05;  // of the mean: what predictions err by; below it nothing is sent. Chosen.
  const double mean = std::accumulate(loads.begin(), loads.end(), 0.0) / ranks;
  const double before = heaviest(loads, now, ranks);
  std::vector<Rank> stay(now.begin(), now.end());
  if (before <= tolerance * mean) return stay;
  std::vector<Rank> moved = move_excess(loads, now, ranks);
  const std::vector<Rank> even = assign_largest_first(loads, ranks);
  if (heaviest(loads, moved, ranks) > std::max(tolerance * mean, heaviest(loads, even, ranks)))
    moved = keep_in_place(loads, even, now, ranks);
  return heaviest(loads, moved, ranks) < before ? moved : stay;
}

std::vector<int> tasks_of_rank(std::span<const Rank> assignment, std::span<const double> loads, Rank rank) {
  std::vector<int> tasks;
  for (std::size_t t = 0; t < assignment.size(); ++t) {
    if (assignment[t] == rank) tasks.push_back(static_cast<int>(t));
  }
  sort_largest_first(tasks, loads);
  return tasks;
}

std::vector<int> batches_of_tasks(std::span<const Rank> assignment, std::span<const double> loads,
                                  int at_a_time) {
  std::vector<int> batches(loads.size());
  std::map<Rank, int> given;
  for (const int task : largest_first(loads)) {
    const auto t = static_cast<std::size_t>(task);
    batches[t] = given[assignment[t]]++ / at_a_time;
  }
  return batches;
}

}  // namespace aeroloom::parallel
