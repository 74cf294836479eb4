/// Facts about a file, be it a mesh, CAD, or a case.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <string>

namespace aeroloom::pipeline {

struct InfoRequest {
  std::string file;
  bool print_json = false;  ///< instead of text
};

/// Looks at the file and prints what it holds, on rank 0. A mesh goes by its extension and is read by all
/// ranks (io/read_mesh.hpp); a case by .yaml or .yml; anything else is taken for CAD, which goes by content.
/// Collective. Throws CollectiveError; CaseError for a case with mistakes.
void show_info(const parallel::Communicator& communicator, const InfoRequest& request);

}  // namespace aeroloom::pipeline
