/// Runs stages of a run: opens their clocks and turns exceptions into exit codes.
#pragma once

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"
#include "pipeline/report/exit_code.hpp"

#include <string>

namespace aeroloom::pipeline {

/// The exit code of an error: that of its kind, or else that of the stage.
report::ExitCode code_of(const parallel::CollectiveError& error, report::ExitCode of_stage);

/// The name of the current stage, for messages of a terminated run. Any thread may call it.
std::string current_stage();

/// Opens the clock of a stage and makes it the current stage, until the end of the scope.
class OpenStage {
public:
  OpenStage(parallel::StageClock& clock, const std::string& name);
  ~OpenStage() { _clock.end(); }
  OpenStage(const OpenStage&) = delete;
  OpenStage& operator=(const OpenStage&) = delete;

private:
  parallel::StageClock& _clock;
};

/// Rethrows the current exception as a StageFailure, with `code` or the code of its kind.
[[noreturn]] void fail_stage(const std::string& name, report::ExitCode code);

/// Runs `work` as the stage `name` and returns its result. Throws StageFailure as fail_stage(). All ranks
/// must throw alike: errors are agreed on, or follow from data that all ranks have.
template <class Work>
auto run_stage(parallel::StageClock& clock, const std::string& name, report::ExitCode code, Work work) {
  const OpenStage open(clock, name);
  try {
    return work();
  } catch (...) {
    fail_stage(name, code);
  }
}

}  // namespace aeroloom::pipeline
