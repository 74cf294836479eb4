#include "pipeline/study/task_schedule.hpp"

#include "parallel/communication/schedule.hpp"

#include <algorithm>
#include <array>

namespace aeroloom::study {

namespace {

using parallel::Rank;

enum class Way {
  largest_first,  ///< to whoever has least
  on_burdens,     ///< to whoever has least, what was done earlier in the round included
  in_batches,     ///< largest first, a few at a time for each rank
  along_curve,    ///< a rank has a stretch of the curve
  rebalanced,     ///< where the piece was made, unless that is uneven
};

struct Kind {
  std::string_view name;
  Way way = Way::largest_first;
};

/// In the order in which they follow one another within a round.
constexpr std::array<Kind, 11> kinds{{{"sampled face", Way::largest_first},
                                      {"curve", Way::largest_first},
                                      {"face", Way::largest_first},
                                      {"divided face", Way::on_burdens},
                                      {"divided part", Way::on_burdens},
                                      {"surface piece", Way::on_burdens},
                                      {"zone", Way::in_batches},
                                      {"core piece", Way::along_curve},
                                      {"improved piece", Way::rebalanced},
                                      {"cavity", Way::largest_first},
                                      {"file", Way::largest_first}}};

constexpr int zones_at_a_time = 4;  // as volume/filling/zone_plan.cpp has it

Way way_of(std::string_view kind) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == kind; });
  return found == kinds.end() ? Way::largest_first : found->way;
}

/// The middle of each task's stretch decides.
std::vector<Rank> deal_along_curve(const std::vector<double>& loads, int ranks) {
  double total = 0, before = 0;
  for (const double load : loads) total += load;
  std::vector<Rank> owners;
  for (const double load : loads) {
    const double middle = total > 0 ? (before + 0.5 * load) / total : 0;
    owners.push_back(std::min(ranks - 1, static_cast<Rank>(middle * ranks)));
    before += load;
  }
  return owners;
}

std::vector<int> batches_of(const std::vector<Rank>& owners, const std::vector<double>& loads) {
  std::vector<int> tasks(loads.size()), batches(loads.size());
  for (std::size_t t = 0; t < tasks.size(); ++t) tasks[t] = static_cast<int>(t);
  std::sort(tasks.begin(), tasks.end(), [&](int a, int b) {
    const auto i = static_cast<std::size_t>(a), k = static_cast<std::size_t>(b);
    return loads[i] != loads[k] ? loads[i] > loads[k] : a < b;
  });
  std::vector<int> given(1, 0);
  for (const int task : tasks) {
    const auto owner = static_cast<std::size_t>(owners[static_cast<std::size_t>(task)]);
    if (given.size() <= owner) given.resize(owner + 1, 0);
    batches[static_cast<std::size_t>(task)] = given[owner]++ / zones_at_a_time;
  }
  return batches;
}

}  // namespace

int order_of_kind(std::string_view kind) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == kind; });
  return static_cast<int>(found - kinds.begin());
}

bool goes_by_pieces(std::string_view stage) {
  return stage == "improve" || stage == "inspect" || stage == "output";
}

Scheduler::Scheduler(int ranks) : _ranks(ranks), _burdens(static_cast<std::size_t>(ranks), 0) {}

TaskSchedule Scheduler::schedule(const TaskGroup& group, bool follows) {
  if (!follows) std::fill(_burdens.begin(), _burdens.end(), 0);
  std::vector<double> loads;
  loads.reserve(group.tasks.size());
  for (const TaskCost& task : group.tasks) loads.push_back(task.predicted);
  TaskSchedule schedule{owners_of(group, loads), {}};
  if (way_of(group.kind) == Way::in_batches) schedule.batches = batches_of(schedule.owners, loads);
  for (std::size_t t = 0; t < loads.size(); ++t)
    _burdens[static_cast<std::size_t>(schedule.owners[t])] += group.tasks[t].burden;
  note_pieces(group, schedule.owners);
  return schedule;
}

std::vector<Rank> Scheduler::owners_of(const TaskGroup& group, const std::vector<double>& loads) {
  switch (way_of(group.kind)) {
    case Way::on_burdens:
      return parallel::assign_largest_first(loads, _burdens);
    case Way::along_curve:
      return deal_along_curve(loads, _ranks);
    case Way::rebalanced: {
      std::vector<Rank> now;
      for (const auto& [number, piece] : _pieces) now.push_back(piece.owner);
      // Pieces that are not those that were made: of a mesh from a file, or of several regions.
      if (now.size() != loads.size()) now = parallel::assign_largest_first(loads, _ranks);
      return parallel::rebalance(loads, now, _ranks);
    }
    case Way::largest_first:
    case Way::in_batches:
      break;
  }
  return parallel::assign_largest_first(loads, _ranks);
}

void Scheduler::note_pieces(const TaskGroup& group, const std::vector<Rank>& owners) {
  const bool is_improved = group.kind == "improved piece", is_core = group.kind == "core piece";
  if (!is_improved && !is_core && group.kind != "zone") return;
  if (is_improved) _pieces.clear();
  const std::int64_t first = is_core && !_pieces.empty() ? _pieces.rbegin()->first + 1 : 0;
  for (std::size_t t = 0; t < owners.size(); ++t)
    _pieces[first + group.tasks[t].number] = {owners[t], group.tasks[t].bytes};
}

}  // namespace aeroloom::study
