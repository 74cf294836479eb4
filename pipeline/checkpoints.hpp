/// Checkpoints: results of stages in OUTPUT/checkpoint, with which a later run resumes.
///
/// The name of a checkpoint is the digest of all that its content depends on: program, geometry, and the keys
/// of the case that matter up to its stage. Only undamaged checkpoints with this digest are used. So the mesh
/// is always that of the case.
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

/// Stages whose results are kept.
enum class SavedStage : std::int8_t { geometry, sizing, surface, volume, improve };
inline constexpr std::size_t saved_stages = 5;

class Checkpoints {
public:
  /// If the run resumes: throws std::invalid_argument for checkpoints of another geometry or program.
  /// Collective.
  Checkpoints(parallel::Communicator communicator, const cases::Case& input, const RunIdentity& identity);

  /// The result of the stage from an earlier run, if it is usable. Logs why an existing one is not.
  /// Collective.
  std::optional<io::CheckpointContent> find(SavedStage stage);
  /// Writes the checkpoint that `draft` makes, if checkpoints are wanted, and removes those that it replaces.
  /// If writing fails, warns and keeps nothing from then on. Collective.
  void keep(SavedStage stage, const std::function<io::CheckpointDraft()>& draft);
  /// The store for tasks of a stage; null without checkpoints. Collective.
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
