#include "pipeline/mesh_case.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/sandbox/sandbox.hpp"
#include "pipeline/run.hpp"

#include <utility>

namespace aeroloom::pipeline {

cases::Case read_case(const parallel::Communicator& communicator, const std::string& file,
                      const std::vector<std::string>& overrides) {
  cases::Case input;
  std::string resolved;
  // Rank 0 alone looks at the file; all learn of an error together.
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) return;
    input = cases::read_case(file, overrides);
    resolved = cases::resolved_yaml(input);
  });
  communicator.broadcast_value(resolved);
  parallel::agree(communicator, [&] {
    if (!communicator.is_root()) input = cases::case_of_resolved(resolved);
  });
  return input;
}

MeshOfCase run(const cases::Case& input, const parallel::Communicator& communicator) {
  if (input.sandbox == parallel::Sandbox::none) parallel::run_without_sandbox(communicator);
  cases::Case in_memory = input;
  in_memory.output.directory.clear();
  in_memory.output.checkpoints = cases::CheckpointUse::none;
  in_memory.output.pictures = false;
  report::RunRecord record;
  try {
    return mesh_of_case(communicator, in_memory, record);
  } catch (const report::StageFailure& failure) {
    throw CaseFailure(failure.stage(), static_cast<int>(failure.code()), failure.what());
  }
}

}  // namespace aeroloom::pipeline
