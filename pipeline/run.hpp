/// Runs a case: from CAD to a mesh on disk.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/report/run_record.hpp"

namespace aeroloom::pipeline {

/// Runs all stages of the case with checks between them and writes the mesh files. Results are copied into
/// `record`, also of a run that fails. Collective. Throws StageFailure on all ranks.
void run_case(const parallel::Communicator& communicator, const cases::Case& input,
              report::RunRecord& record);

}  // namespace aeroloom::pipeline
