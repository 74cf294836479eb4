/// The run's report: report.json for machines, a table for people. Keys are documented in docs/report.md.
#pragma once

#include "pipeline/run.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// How a run ended, for the report.
struct RunOutcome {
  ExitCode code = ExitCode::ok;
  std::string stage;    ///< that failed; empty when none did
  std::string message;  ///< of the failure
};

/// The report as JSON text. `stages` are the summaries over all ranks. Rank 0 calls it.
std::string report_json(const Case& input, const RunRecord& record,
                        const std::vector<parallel::StageSummary>& stages, const RunOutcome& outcome,
                        int ranks);

/// The report of an improved file.
std::string improve_report_json(const std::string& file, const Case& input, const RunRecord& record,
                                const std::vector<parallel::StageSummary>& stages, const RunOutcome& outcome,
                                int ranks);

/// The table of stage times and the quality of the mesh, for the terminal.
std::string report_table(const RunRecord& record, const std::vector<parallel::StageSummary>& stages,
                         int ranks);

}  // namespace aeroloom::pipeline
