/// One run: from a case to a mesh on disk.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/report/run_record.hpp"

namespace aeroloom::pipeline {

/// Runs all stages of the case in order, with validity checks between them, and writes mesh.pvtu,
/// surface.pvtp and, where regions share faces, interfaces.pvtp. Collective. Throws StageFailure on all
/// ranks.
void run_case(const parallel::Communicator& communicator, const cases::Case& input,
              report::RunRecord& record);

}  // namespace aeroloom::pipeline
