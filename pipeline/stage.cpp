#include "pipeline/stage.hpp"

#include "parallel/observation/memory_limit.hpp"
#include "parallel/sandbox/sandbox.hpp"

#include <exception>
#include <mutex>
#include <new>
#include <stdexcept>

namespace aeroloom::pipeline {
namespace {

struct Stage {
  std::mutex mutex;
  std::string name = "start";
};
Stage& stage_under_way() {
  static Stage stage;
  return stage;
}

}  // namespace

OpenStage::OpenStage(parallel::StageClock& clock, const std::string& name) : _clock(clock) {
  clock.begin(name);
  const std::lock_guard guard(stage_under_way().mutex);
  stage_under_way().name = name;
}

std::string current_stage() {
  const std::lock_guard guard(stage_under_way().mutex);
  return stage_under_way().name;
}

void fail_stage(const std::string& name, report::ExitCode code) {
  using report::ExitCode, report::StageFailure;
  try {
    throw;
  } catch (const parallel::CollectiveError& error) {
    throw StageFailure(name, code_of(error, code), error.what());
  } catch (const std::bad_alloc&) {
    parallel::give_up_without_memory();
    throw StageFailure(name, ExitCode::resources, parallel::out_of_memory_text());
  } catch (const parallel::SandboxInterrupted& error) {
    throw StageFailure(name, ExitCode::resources, error.what());
  } catch (const std::invalid_argument& error) {
    throw StageFailure(name, ExitCode::usage, error.what());
  } catch (const std::logic_error& error) {
    throw StageFailure(name, ExitCode::bug, error.what());
  } catch (const std::exception& error) {
    throw StageFailure(name, code, error.what());
  }
}

report::ExitCode code_of(const parallel::CollectiveError& error, report::ExitCode of_stage) {
  switch (error.kind()) {
    case parallel::FailureKind::files:
      return report::ExitCode::files;
    case parallel::FailureKind::resources:
      return report::ExitCode::resources;
    case parallel::FailureKind::bug:
      return report::ExitCode::bug;
    case parallel::FailureKind::input:
      break;
  }
  return of_stage;
}

}  // namespace aeroloom::pipeline
