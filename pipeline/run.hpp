/// Runs a case: from CAD to a mesh, on disk or in memory.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/mesh_case.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/report/run_record.hpp"

namespace aeroloom::pipeline {

/// Runs all stages of the case with checks between them and writes the mesh files. Results are copied into
/// `record`, also of a run that fails. Collective. Throws StageFailure on all ranks.
void run_case(const parallel::Communicator& communicator, const cases::Case& input,
              report::RunRecord& record);

/// The same without the files, and without pictures. Without an output directory no stage writes any file.
/// Limits that the mesh misses are in the result.
MeshOfCase mesh_of_case(const parallel::Communicator& communicator, const cases::Case& input,
                        report::RunRecord& record);

}  // namespace aeroloom::pipeline
