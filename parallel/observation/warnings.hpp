/// The warnings of a run, for its report.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::parallel {

/// Warnings that log_warning() has printed, once for each text.
struct Warning {
  std::string message;
  Rank rank = 0;           ///< the first that said it
  std::int64_t times = 1;  ///< said by all ranks together
};

struct Warnings {
  std::vector<Warning> kept;  ///< by rank, then in the order in which they were said
  std::int64_t left_out = 0;  ///< times that others were said, for which there was no room
};

/// Keeps a warning until they are gathered. Of a rank at most 100 texts of 4000 bytes are kept, in 64 KiB
/// together; the rest is counted.
void keep_warning(const std::string& message);

/// Takes what all ranks have kept. Rank 0 gets it, the others nothing. Of other ranks than 0 all together
/// send 4 MiB at most, or a kilobyte each. Collective.
Warnings take_warnings(const Communicator& communicator);

}  // namespace aeroloom::parallel
