/// Stages of a run: their clocks, and how what goes wrong in them ends the program.
#pragma once

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"
#include "pipeline/report/exit_code.hpp"

#include <string>

namespace aeroloom::pipeline {

/// The exit code of a failure: that of the stage, unless its kind demands another.
report::ExitCode code_of(const parallel::CollectiveError& error, report::ExitCode of_stage);

/// The stage under way, for what is said when the program is asked to end; another thread may call it.
std::string current_stage();

/// The clock of a stage is open and its name the current one from here to the end of the scope.
class OpenStage {
public:
  OpenStage(parallel::StageClock& clock, const std::string& name);
  ~OpenStage() { _clock.end(); }
  OpenStage(const OpenStage&) = delete;
  OpenStage& operator=(const OpenStage&) = delete;

private:
  parallel::StageClock& _clock;
};

/// Throws the exception that is being handled as a StageFailure with `code`, or with the code that its kind
/// demands.
[[noreturn]] void fail_stage(const std::string& name, report::ExitCode code);

/// Runs `work` as stage `name`: opens and closes its clock, and turns what it throws into a StageFailure as
/// fail_stage() does. What is thrown here has been agreed on by all ranks or follows from data that all ranks
/// share.
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
