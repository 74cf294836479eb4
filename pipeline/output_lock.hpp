/// Allows one run at a time in an output directory.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/storage/file_descriptor.hpp"

#include <string>

namespace aeroloom::pipeline {

/// Locks FOLDER/.lock on rank 0 during its lifetime (a lock of the open file). The system releases the lock
/// when the process ends, so a killed run blocks nothing. The file names host and process. Does nothing on
/// file systems without locks.
class OutputLock {
public:
  /// Collective. Throws CollectiveError (files) on all ranks if another run holds the folder.
  OutputLock(const parallel::Communicator& communicator, const std::string& folder);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

private:
  std::string _path;
  parallel::FileDescriptor _file;
};

}  // namespace aeroloom::pipeline
