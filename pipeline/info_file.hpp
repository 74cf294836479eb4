/// The command `info`: describes a mesh, CAD or case file.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <string>

namespace aeroloom::pipeline {

struct InfoRequest {
  std::string file;
  bool print_json = false;  ///< instead of text
  std::string encoding;     ///< of names in files of geometry that are not UTF-8; empty: latin-1
};

/// Reads the file and prints its facts on rank 0. Meshes are recognised by extension and read by all ranks
/// (io/read_mesh.hpp), cases by .yaml or .yml; all other files are read as CAD. Collective. Throws
/// CollectiveError.
void show_info(const parallel::Communicator& communicator, const InfoRequest& request);

}  // namespace aeroloom::pipeline
