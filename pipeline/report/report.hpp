/// The report of a run: report.json for machines, report.html for people, both from one record. Keys:
/// docs/report.md; how to read it: docs/reading_the_report.md.
#pragma once

#include "pipeline/report/report_json.hpp"
#include "pipeline/report/run_record.hpp"
#include "pipeline/report/text_table.hpp"

#include <string>

namespace aeroloom::report {

/// Writes report.json and report.html to the output directory, and tasks.csv where the case asks for it, each
/// in one piece or not at all. `subject` is what was run and how it ended. Returns the table for the terminal
/// on rank 0. Collective; throws CollectiveError when a file cannot be written.
std::string write_report(const parallel::Communicator& communicator, const cases::Case& input,
                         const RunRecord& record, const RunOutcome& outcome, const ReportSubject& subject);

/// report.json of a run that was asked to end: its case and what became of it, nothing that ranks would have
/// to agree on. On rank 0, on any thread. Throws std::ios_base::failure.
void write_last_report(const cases::Case& input, const RunOutcome& outcome, const ReportSubject& subject,
                       int ranks);

}  // namespace aeroloom::report
