/// The command `improve`: improves a mesh from a file.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/run.hpp"

#include <string>

namespace aeroloom::pipeline {

/// Reads a mesh (imported_mesh.hpp), improves it, and writes mesh.pvtu and surface.pvtp. Its boundary and the
/// faces between regions stay unchanged. Only `improve`, `volume.piece_tets` and `output` of the case matter.
/// Collective. Throws StageFailure on all ranks.
void improve_file(const parallel::Communicator& communicator, const std::string& file,
                  const cases::Case& input, report::RunRecord& record);

}  // namespace aeroloom::pipeline
