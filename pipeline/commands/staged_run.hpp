/// The record of a run, its report and its end, the same for all commands with stages.
#pragma once

#include "pipeline/commands/command.hpp"
#include "pipeline/report/report.hpp"
#include "pipeline/run.hpp"

#include <functional>

namespace aeroloom::pipeline {

/// Does the stages (run_case, improve_file) and reports, a failure too as far as the output directory can be
/// written. Returns the exit code. Collective.
int run_stages(const Invocation& invocation, const cases::Case& input, const report::ReportSubject& subject,
               const std::function<void(report::RunRecord&)>& stages);

}  // namespace aeroloom::pipeline
