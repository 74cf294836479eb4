/// What the result of a run depends on besides its configuration: the program and the geometry.
#pragma once

#include "parallel/communicator.hpp"
#include "parallel/digest.hpp"
#include "pipeline/case.hpp"

#include <string>

namespace aeroloom::pipeline {

struct RunIdentity {
  std::string version;      ///< of the program and its libraries
  parallel::Digest build;   ///< of the program's file
  std::string input;        ///< name of the geometry file, or of what is built in
  parallel::Digest digest;  ///< of the bytes of that file, or of the dimensions
};

/// Rank 0 reads the files. A geometry file that cannot be read has the digest of nothing: who reads it tells.
/// Collective.
RunIdentity identify_run(const parallel::Communicator& communicator, const Case& input);

}  // namespace aeroloom::pipeline
