/// What commands with stages share: the record of a run, its report and its end.
#pragma once

#include "pipeline/commands/command.hpp"
#include "pipeline/run.hpp"

#include <functional>
#include <string>

namespace aeroloom::pipeline {

/// Does the stages (run_case, improve_file) and reports, a failure too as far as the output directory can be
/// written. `improved_file` is the mesh that is improved; empty where a case is run. Returns the exit code.
/// Collective.
int run_stages(const parallel::Communicator& communicator, const Case& input,
               const std::string& improved_file, const std::function<void(RunRecord&)>& stages);

}  // namespace aeroloom::pipeline
