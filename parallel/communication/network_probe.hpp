/// How long messages take here: measured between the ranks of the program.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::parallel {

/// One length of messages.
struct MessageTiming {
  std::int64_t bytes = 0;
  double seconds = 0;  ///< to a partner and from it at a time, the least of its repeats, of the slowest rank
};

/// Seconds for all lengths, the same on every rank.
struct NetworkProbe {
  std::vector<MessageTiming> messages;  ///< by bytes
  double reduction_seconds = 0;         ///< of one number over all ranks, the least of its repeats
  /// Of the shortest message or, where that is longer, of one step of a reduction.
  double latency_seconds = 0;
  double bytes_per_second = 0;  ///< what the longest message takes beyond that
};

/// Rank r exchanges messages with rank r + P/2, all such pairs at a time, then all ranks reduce. Takes
/// about a second. Collective; throws std::invalid_argument on one rank.
NetworkProbe probe_network(const Communicator& communicator);

}  // namespace aeroloom::parallel
