/// How tasks of each kind are scheduled: the program's own schedule, for any number of ranks.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "pipeline/study/costs.hpp"

#include <map>
#include <string_view>
#include <vector>

namespace aeroloom::study {

/// Tasks of a group on ranks. Batches of all ranks wait for each other.
struct TaskSchedule {
  std::vector<parallel::Rank> owners;  ///< by task
  std::vector<int> batches;            ///< by task; empty: all in one
};

/// Schedules one group after another as a run on so many ranks does.
class Scheduler {
public:
  explicit Scheduler(int ranks);

  /// `follows`: whether the group goes on in the round of the group before it.
  TaskSchedule schedule(const TaskGroup& group, bool follows);
  /// A piece of the mesh as it lies now.
  struct HeldPiece {
    parallel::Rank owner;
    double bytes;
  };
  /// By number; those of the core after those of zones. Empty before there are any.
  const std::map<std::int64_t, HeldPiece>& pieces() const { return _pieces; }

private:
  std::vector<parallel::Rank> owners_of(const TaskGroup& group, const std::vector<double>& loads);
  void note_pieces(const TaskGroup& group, const std::vector<parallel::Rank>& owners);

  int _ranks;
  std::vector<double> _burdens;
  std::map<std::int64_t, HeldPiece> _pieces;
};

/// Whether what a stage does beside its tasks is done piece by piece, where the pieces are.
bool goes_by_pieces(std::string_view stage);

}  // namespace aeroloom::study
