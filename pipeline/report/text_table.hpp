/// The report of a run on the terminal.
#pragma once

#include "pipeline/run.hpp"

#include <string>
#include <vector>

namespace aeroloom::pipeline {

/// The table of stage times and the quality of the mesh.
std::string report_table(const RunRecord& record, const std::vector<parallel::StageSummary>& stages,
                         int ranks);

}  // namespace aeroloom::pipeline
