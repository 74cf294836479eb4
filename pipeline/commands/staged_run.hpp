/// Common parts of commands with stages: record, report, exit code.
#pragma once

#include "pipeline/commands/command.hpp"
#include "pipeline/report/report.hpp"

#include <functional>

namespace aeroloom::pipeline {

/// Calls `stages` (run_case, improve_file) and writes the report, also of a failed run if the output
/// directory is writable. Returns the exit code. Collective.
int run_stages(const Invocation& invocation, const cases::Case& input, const report::ReportSubject& subject,
               const std::function<void(report::RunRecord&)>& stages);

}  // namespace aeroloom::pipeline
