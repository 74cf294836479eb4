/// Functions that count messages; message_counts.hpp defines the counts. Internal to parallel/.
#pragma once

#include "parallel/communication/message_counts.hpp"
#include "parallel/communication/session.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::parallel::session {

/// Counts one message of a kind.
void count_message(Messages MessageCounts::*kind, std::uint64_t bytes);

/// Counts one exchange, and the bytes that this rank passed to it.
void count_exchange(Messages ExchangeCounts::*kind, std::uint64_t bytes);

/// Each counts one operation of a group as an exchange, and as messages unless the group has one rank.
void count_barrier(const CommunicatorHandle& group);
void count_broadcast(const CommunicatorHandle& group, int root, std::uint64_t bytes);
/// `bytes`: of each rank.
void count_all_gather(const CommunicatorHandle& group, const std::vector<std::uint64_t>& bytes);
/// `bytes`: from each rank, the same on all.
void count_all_gather_of_equals(const CommunicatorHandle& group, std::uint64_t bytes);
void count_gather(const CommunicatorHandle& group, int root, std::uint64_t bytes);
void count_reduction(const CommunicatorHandle& group, std::uint64_t bytes);
void count_scan(const CommunicatorHandle& group, std::uint64_t bytes);
/// The consensus in Communicator::exchange.
void count_consensus(const CommunicatorHandle& group);

}  // namespace aeroloom::parallel::session
