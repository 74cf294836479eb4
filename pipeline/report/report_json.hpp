/// report.json. Keys: docs/report.md, docs/report.schema.json.
#pragma once

#include "parallel/observation/warnings.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/report/run_record.hpp"

#include <string>
#include <vector>

namespace aeroloom::report {

/// How a run ended, for the report.
struct RunOutcome {
  ExitCode code = ExitCode::ok;
  std::string stage;                          ///< that failed; empty when none did
  std::string message;                        ///< of the failure
  std::vector<std::string> older_files = {};  ///< of meshes in the output directory, not of this run
};

/// The case and the file that were run.
struct ReportSubject {
  std::string case_file;      ///< as it was named; empty: none
  std::string improved_file;  ///< a mesh, of the command improve; else empty
};

/// Facts that a report tells besides the case and the record.
struct ReportFacts {
  RunOutcome outcome;
  ReportSubject subject;
  int ranks = 1;
  std::vector<parallel::StageSummary> stages;  ///< over all ranks
  parallel::Warnings warnings;                 ///< of all ranks
  std::string date;                            ///< ISO 8601
  std::string tasks = {};                      ///< of all ranks, as task_table() has them
};

/// The report as JSON text, UTF-8 whatever bytes names are made of. Rank 0 calls it.
std::string report_json(const cases::Case& input, const RunRecord& record, const ReportFacts& facts);

}  // namespace aeroloom::report
