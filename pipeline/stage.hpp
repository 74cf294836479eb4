/// Stages of a run: their clocks, and how what goes wrong in them ends the program.
#pragma once

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/memory_limit.hpp"
#include "parallel/sandbox/sandbox.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/run.hpp"

#include <new>
#include <string>

namespace aeroloom::pipeline {

/// The exit code of a failure: that of the stage, unless its kind demands another.
report::ExitCode code_of(const parallel::CollectiveError& error, report::ExitCode of_stage);

/// Runs `work` as stage `name`: opens and closes its clock, and turns what it throws into a StageFailure with
/// `code`, or the code that the kind of failure demands. What is thrown here has been agreed on by all ranks
/// or follows from data all ranks share.
/// For what is said when the program is asked to end; may be called on another thread.
void set_current_stage(const std::string& name);
std::string current_stage();

template <class Work>
auto run_stage(report::RunRecord& record, const std::string& name, report::ExitCode code, Work work) {
  struct Clock {
    parallel::StageClock& clock;
    ~Clock() { clock.end(); }
  };
  record.clock.begin(name);
  set_current_stage(name);
  const Clock closes{record.clock};
  try {
    return work();
  } catch (const parallel::CollectiveError& error) {
    throw report::StageFailure(name, code_of(error, code), error.what());
  } catch (const std::bad_alloc&) {
    parallel::give_up_without_memory();
    throw report::StageFailure(name, report::ExitCode::resources, parallel::out_of_memory_text());
  } catch (const parallel::SandboxInterrupted& error) {
    throw report::StageFailure(name, report::ExitCode::resources, error.what());
  } catch (const std::invalid_argument& error) {
    throw report::StageFailure(name, report::ExitCode::usage, error.what());
  } catch (const std::logic_error& error) {
    throw report::StageFailure(name, report::ExitCode::bug, error.what());
  } catch (const std::exception& error) {
    throw report::StageFailure(name, code, error.what());
  }
}

}  // namespace aeroloom::pipeline
