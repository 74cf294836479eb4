/// The program and the geometry, on which the result of a run depends besides its configuration.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/storage/digest.hpp"
#include "pipeline/case/case.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::pipeline {

struct RunIdentity {
  std::string version;      ///< of the program and its libraries
  parallel::Digest build;   ///< of the program's file
  std::string input;        ///< name of the geometry file, or of what is built in
  bool is_known = true;     ///< whether the files of the geometry can be read
  parallel::Digest digest;  ///< of the bytes of these files, or of the dimensions and these
  parallel::Digest files;   ///< of the bytes alone
  std::int64_t bytes = 0;   ///< of these files
};

/// Rank 0 reads the files. That a geometry file cannot be read is for the reader to tell. Collective.
RunIdentity identify_run(const parallel::Communicator& communicator, const cases::Case& input);

/// Throws std::filesystem::filesystem_error if the files have changed since identify_run(). One rank calls
/// it, after the geometry was read.
void require_same_file(const RunIdentity& identity, const cases::Case& input);

}  // namespace aeroloom::pipeline
