/// Counts what is sent; what is counted how: message_counts.hpp. Internal to parallel/.
#pragma once

#include "parallel/communication/message_counts.hpp"
#include "parallel/communication/session.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::parallel::session {

/// Counts one message of a kind.
void count_message(Messages MessageCounts::*kind, std::uint64_t bytes);

/// Counts one exchange, with what this rank handed over.
void count_exchange(Messages ExchangeCounts::*kind, std::uint64_t bytes);

/// Each counts one operation of a group, and what was to be exchanged. Nothing is sent in a group of one
/// rank.
void count_barrier(const CommunicatorHandle& group);
void count_broadcast(const CommunicatorHandle& group, int root, std::uint64_t bytes);
/// Of the bytes of each rank.
void count_all_gather(const CommunicatorHandle& group, const std::vector<std::uint64_t>& bytes);
/// Of this many from each rank.
void count_all_gather_of_equals(const CommunicatorHandle& group, std::uint64_t bytes);
void count_gather(const CommunicatorHandle& group, int root, std::uint64_t bytes);
void count_reduction(const CommunicatorHandle& group, std::uint64_t bytes);
void count_scan(const CommunicatorHandle& group, std::uint64_t bytes);
/// The consensus of an exchange.
void count_consensus(const CommunicatorHandle& group);

}  // namespace aeroloom::parallel::session
