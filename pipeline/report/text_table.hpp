/// The report of a run on the terminal.
#pragma once

#include "pipeline/report/run_record.hpp"

#include <string>
#include <vector>

namespace aeroloom::report {

/// A table of stage times, and the quality of the mesh.
std::string report_table(const RunRecord& record, const std::vector<parallel::StageSummary>& stages,
                         int ranks);

}  // namespace aeroloom::report
