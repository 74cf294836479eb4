#include "pipeline/stage.hpp"

#include <mutex>
#include <string>

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

void set_current_stage(const std::string& name) {
  const std::lock_guard guard(stage_under_way().mutex);
  stage_under_way().name = name;
}

std::string current_stage() {
  const std::lock_guard guard(stage_under_way().mutex);
  return stage_under_way().name;
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
