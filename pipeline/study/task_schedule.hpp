/// Schedules recorded tasks on any number of ranks as the program does.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "pipeline/study/costs.hpp"

#include <map>
#include <string_view>
#include <vector>

namespace aeroloom::study {

/// A schedule of a group. All ranks wait for each other between batches.
struct TaskSchedule {
  std::vector<parallel::Rank> owners;  ///< by task
  std::vector<int> batches;            ///< by task; empty: a single batch
};

/// Schedules groups one after another, as a run on this number of ranks does.
class Scheduler {
public:
  explicit Scheduler(int ranks);

  /// `follows`: the group continues the round of the previous group.
  TaskSchedule schedule(const TaskGroup& group, bool follows);
  /// A piece of the mesh at present.
  struct HeldPiece {
    parallel::Rank owner;
    double bytes;
  };
  /// By number; pieces of the core follow those of zones. Empty before pieces exist.
  const std::map<std::int64_t, HeldPiece>& pieces() const { return _pieces; }

private:
  std::vector<parallel::Rank> owners_of(const TaskGroup& group, const std::vector<double>& loads);
  void note_pieces(const TaskGroup& group, const std::vector<parallel::Rank>& owners);

  int _ranks;
  std::vector<double> _burdens;
  std::map<std::int64_t, HeldPiece> _pieces;
};

/// Whether the work of a stage outside tasks is done by pieces, on the ranks that own them.
bool goes_by_pieces(std::string_view stage);

}  // namespace aeroloom::study
