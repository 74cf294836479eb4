/// Checkpoints of a run: what its stages have made, in OUTPUT/checkpoint, for a run that goes on from there.
///
/// A checkpoint is named by the digest of all that its content depends on: program, geometry, and the keys of
/// the case that matter up to its stage. One that is of something else is not taken; nor is a damaged one. So
/// whatever lies there, the mesh is that of the case.
#pragma once

#include "io/checkpoint_file.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/storage/task_store.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/run_identity.hpp"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace aeroloom::pipeline {

/// Stages whose result is kept.
enum class SavedStage : std::int8_t { geometry, sizing, surface, volume, improve };
inline constexpr std::size_t saved_stages = 5;

class Checkpoints {
public:
  /// Where a run is to go on, refuses checkpoints of another geometry or program: throws
  /// std::invalid_argument. Collective.
  Checkpoints(parallel::Communicator communicator, const cases::Case& input, const RunIdentity& identity);

  /// The result of the stage from an earlier run, if it can be had; says why where it is there and cannot.
  /// Collective.
  std::optional<io::CheckpointContent> find(SavedStage stage);
  /// Keeps what `draft` gives, where that is wanted, and lets go what it makes needless. Where it cannot be
  /// written warns, and keeps nothing from then on. Collective.
  void keep(SavedStage stage, const std::function<io::CheckpointDraft()>& draft);
  /// For the tasks of a stage; null where nothing is kept. Collective.
  parallel::TaskStore* tasks(SavedStage stage);

private:
  std::string path_of(SavedStage stage) const;
  io::CheckpointLabel label_of(SavedStage stage) const;
  std::optional<io::CheckpointLabel> read_label(SavedStage stage) const;
  bool is_of_this_case(SavedStage stage) const;
  void refuse_imported() const;
  void remove_needless(SavedStage kept);
  void remove_left_over(SavedStage found);
  void remove_volume_of(SavedStage kept);
  bool attempt(const std::function<void()>& work);

  parallel::Communicator _communicator;
  const cases::Case& _input;
  RunIdentity _identity;
  std::string _folder;
  bool _writes = false, _resumes = false;
  std::array<std::unique_ptr<parallel::TaskStore>, saved_stages> _tasks;
};

}  // namespace aeroloom::pipeline
