/// Identifies the program and the geometry of a run by digests.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/storage/digest.hpp"
#include "pipeline/case/case.hpp"

#include <cstdint>
#include <string>

namespace aeroloom::pipeline {

struct RunIdentity {
  std::string version;     ///< of the program and its libraries
  parallel::Digest build;  ///< of the executable
  std::string input;       ///< name of the geometry file, or of the built-in geometry
  bool is_known = true;    ///< whether the geometry files are readable
  parallel::Digest
      digest;  ///< of the files' bytes; of a built-in geometry: of its dimensions and the parts' bytes
  parallel::Digest files;  ///< of the files' bytes alone
  std::int64_t bytes = 0;  ///< size of the files
};

/// Rank 0 reads the files. An unreadable file is no error here; the CAD reader reports it. Collective.
RunIdentity identify_run(const parallel::Communicator& communicator, const cases::Case& input);

/// Throws std::filesystem::filesystem_error if the files have changed since identify_run(). Rank 0 calls it
/// after the geometry was read.
void require_same_file(const RunIdentity& identity, const cases::Case& input);

/// What the log says of the files of the geometry; empty without any, or where one is unreadable.
std::string text_of_files(const RunIdentity& identity, const cases::Case& input);

}  // namespace aeroloom::pipeline
