/// Measures latency and bandwidth between the ranks of the program.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::parallel {

/// The time of messages of one length.
struct MessageTiming {
  std::int64_t bytes = 0;
  double seconds = 0;  ///< both ways at once; the least of the repeats, on the slowest rank
};

/// The result of a probe, the same on every rank.
struct NetworkProbe {
  std::vector<MessageTiming> messages;  ///< by bytes
  double reduction_seconds = 0;         ///< of one number over all ranks; the least of the repeats
  /// The longer of the shortest message and one step of a reduction.
  double latency_seconds = 0;
  double bytes_per_second = 0;  ///< of the longest message, latency subtracted
};

/// Rank r exchanges messages with rank r + P/2, in all pairs at once; then all ranks reduce. Takes about a
/// second. Collective. Throws std::invalid_argument if there is only one rank.
NetworkProbe probe_network(const Communicator& communicator);

}  // namespace aeroloom::parallel
