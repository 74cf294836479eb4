/// One run at a time in a folder.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/storage/file_descriptor.hpp"

#include <string>

namespace aeroloom::pipeline {

/// Keeps other runs out of an output directory as long as it lives: FOLDER/.lock, locked by rank 0 for its
/// open file. The system gives that up with the process, however it ends, so what a killed run leaves is no
/// hindrance; the file tells host and process. Where a file system has no locks there is none.
class OutputLock {
public:
  /// Collective. Throws CollectiveError (files) on all ranks where another run has the folder.
  OutputLock(const parallel::Communicator& communicator, const std::string& folder);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

private:
  std::string _path;
  parallel::FileDescriptor _file;
};

}  // namespace aeroloom::pipeline
