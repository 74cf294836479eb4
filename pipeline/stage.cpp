#include "pipeline/stage.hpp"

namespace aeroloom::pipeline {

ExitCode code_of(const parallel::CollectiveError& error, ExitCode of_stage) {
  switch (error.kind()) {
    case parallel::FailureKind::files:
      return ExitCode::files;
    case parallel::FailureKind::resources:
      return ExitCode::resources;
    case parallel::FailureKind::bug:
      return ExitCode::bug;
    case parallel::FailureKind::input:
      break;
  }
  return of_stage;
}

}  // namespace aeroloom::pipeline
