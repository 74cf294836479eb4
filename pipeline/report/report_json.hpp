/// Writes report.json. Keys: docs/report.md, docs/report.schema.json.
#pragma once

#include "parallel/observation/warnings.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/report/run_record.hpp"

#include <string>
#include <vector>

namespace aeroloom::report {

/// How a run ended.
struct RunOutcome {
  ExitCode code = ExitCode::ok;
  std::string stage;                          ///< the failed stage; empty if none failed
  std::string message;                        ///< of the failure
  std::vector<std::string> older_files = {};  ///< mesh files in the output directory from other runs
};

/// The file that was run.
struct ReportSubject {
  std::string case_file;      ///< the case file as named by the user; empty: none
  std::string improved_file;  ///< the mesh of the command improve; else empty
};

/// Facts for the report besides the case and the record.
struct ReportFacts {
  RunOutcome outcome;
  ReportSubject subject;
  int ranks = 1;
  std::vector<parallel::StageSummary> stages;  ///< over all ranks
  parallel::Warnings warnings;                 ///< of all ranks
  std::string date;                            ///< ISO 8601
  std::string tasks = {};                      ///< of all ranks, as task_table() returns them
};

/// The report as JSON, valid UTF-8 whatever names contain. Called on rank 0.
std::string report_json(const cases::Case& input, const RunRecord& record, const ReportFacts& facts);

}  // namespace aeroloom::report
