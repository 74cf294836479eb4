/// Writes tasks.csv, the table of all tasks of a run.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"

#include <string>

namespace aeroloom::report {

/// A heading and a row for each task, comma-separated, by rank and then in order of execution. Empty except
/// on rank 0. Collective.
std::string task_table(const parallel::Communicator& communicator, const parallel::StageClock& clock);

}  // namespace aeroloom::report
