/// Improvement of a mesh from another program.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/run.hpp"

#include <string>

namespace aeroloom::pipeline {

/// Reads a mesh (imported_mesh.hpp), improves it with its boundary and the boundaries between its regions
/// kept as they are, and writes mesh.pvtu and surface.pvtp. Of the case `improve`, `volume.piece_tets` and
/// `output` count. Collective. Throws StageFailure on all ranks.
void improve_file(const parallel::Communicator& communicator, const std::string& file,
                  const cases::Case& input, report::RunRecord& record);

}  // namespace aeroloom::pipeline
