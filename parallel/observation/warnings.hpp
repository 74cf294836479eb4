/// Collects the warnings of a run for its report.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::parallel {

/// A warning of log_warning(), once for each text.
struct Warning {
  std::string message;
  Rank rank = 0;           ///< the lowest that printed it
  std::int64_t times = 1;  ///< printed, on all ranks together
};

struct Warnings {
  std::vector<Warning> kept;  ///< by rank, then in the order of printing
  std::int64_t left_out = 0;  ///< number of warnings for which there was no room
};

/// Keeps a warning until take_warnings(). A rank keeps at most 100 texts of 4000 bytes, 64 KiB in all, and
/// counts the others.
void keep_warning(const std::string& message);

/// Takes the kept warnings of all ranks. Rank 0 gets them, the others get none. The other ranks send at most
/// 4 MiB together, or a kilobyte each if that is more. Collective.
Warnings take_warnings(const Communicator& communicator);

}  // namespace aeroloom::parallel
