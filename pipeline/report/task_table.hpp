/// The tasks of a run as a table.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"

#include <string>

namespace aeroloom::report {

/// All ranks' tasks as comma-separated values, a row for each under a line of names, by rank, in the order in
/// which the rank did them; empty but on rank 0. Collective.
std::string task_table(const parallel::Communicator& communicator, const parallel::StageClock& clock);

}  // namespace aeroloom::report
