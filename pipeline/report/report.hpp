/// Writes the report of a run: report.json for programs, report.html for people. Keys: docs/report.md; guide:
/// docs/reading_the_report.md.
#pragma once

#include "pipeline/report/report_json.hpp"
#include "pipeline/report/run_record.hpp"
#include "pipeline/report/text_table.hpp"

#include <string>

namespace aeroloom::report {

/// Writes report.json, report.html and, if the case asks for it, tasks.csv to the output directory. An
/// incomplete file never replaces an old one. Returns the table and the warnings for the terminal on rank 0.
/// Collective;
/// throws CollectiveError if a file cannot be written.
std::string write_report(const parallel::Communicator& communicator, const cases::Case& input,
                         const RunRecord& record, const RunOutcome& outcome, const ReportSubject& subject);

/// Writes report.json of a terminated run: the case and how it ended, without communication. Called on rank
/// 0, by any thread. Throws std::ios_base::failure.
void write_last_report(const cases::Case& input, const RunOutcome& outcome, const ReportSubject& subject,
                       int ranks);

}  // namespace aeroloom::report
