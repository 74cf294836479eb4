#include "pipeline/study/task_schedule.hpp"

#include "parallel/communication/schedule.hpp"

#include <algorithm>

namespace aeroloom::study {

namespace {

using parallel::Rank;
using parallel::TaskAssignment;
using parallel::TaskKind;

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

}  // namespace

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
  const int at_a_time = group.kind ? parallel::row_of(*group.kind).at_a_time : 0;
  if (at_a_time > 0) schedule.batches = parallel::batches_of_tasks(schedule.owners, loads, at_a_time);
  for (std::size_t t = 0; t < loads.size(); ++t)
    _burdens[static_cast<std::size_t>(schedule.owners[t])] += group.tasks[t].burden;
  note_pieces(group, schedule.owners);
  return schedule;
}

std::vector<Rank> Scheduler::owners_of(const TaskGroup& group, const std::vector<double>& loads) {
  switch (group.kind ? parallel::row_of(*group.kind).assignment : TaskAssignment::largest_first) {
    case TaskAssignment::on_burdens:
      return parallel::assign_largest_first(loads, _burdens);
    case TaskAssignment::along_curve:
      return deal_along_curve(loads, _ranks);
    case TaskAssignment::rebalanced: {
      std::vector<Rank> now;
      for (const auto& [number, piece] : _pieces) now.push_back(piece.owner);
      // Pieces that are not those that were made: of a mesh from a file, or of several regions.
      if (now.size() != loads.size()) now = parallel::assign_largest_first(loads, _ranks);
      return parallel::rebalance(loads, now, _ranks);
    }
    case TaskAssignment::largest_first:
      break;
  }
  return parallel::assign_largest_first(loads, _ranks);
}

void Scheduler::note_pieces(const TaskGroup& group, const std::vector<Rank>& owners) {
  const bool is_improved = group.kind == TaskKind::improved_piece,
             is_core = group.kind == TaskKind::core_piece;
  if (!is_improved && !is_core && group.kind != TaskKind::zone) return;
  if (is_improved) _pieces.clear();
  const std::int64_t first = is_core && !_pieces.empty() ? _pieces.rbegin()->first + 1 : 0;
  for (std::size_t t = 0; t < owners.size(); ++t)
    _pieces[first + group.tasks[t].number] = {owners[t], group.tasks[t].bytes};
}

}  // namespace aeroloom::study
