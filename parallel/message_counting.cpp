#include "parallel/message_counting.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace aeroloom::parallel {
namespace {

MessageCounts& sent() {
  static MessageCounts instance;
  return instance;
}

void count_collective(const CommunicatorHandle& group, std::uint64_t bytes) {
  if (group.size > 1) session::count_message(&MessageCounts::collective, bytes);
}

/// Values that a rank sends while all ranks reduce one each. Ranks beyond a power of two hand their value to
/// a neighbour, which takes part for them and tells them the result.
std::uint64_t values_sent_in_reduction(int rank, int ranks) {
  const int doubling = static_cast<int>(std::bit_floor(static_cast<unsigned>(ranks)));
  const int beyond = ranks - doubling;
  const auto steps = static_cast<std::uint64_t>(std::countr_zero(static_cast<unsigned>(doubling)));
  if (rank >= 2 * beyond) return steps;
  return rank % 2 == 0 ? 1 : steps + 1;
}

template <class Join>
void join_each(MessageCounts& counts, const MessageCounts& others, Join join) {
  for (const auto kind :
       {&MessageCounts::collective, &MessageCounts::neighbour, &MessageCounts::rendezvous}) {
    join((counts.*kind).count, (others.*kind).count);
    join((counts.*kind).bytes, (others.*kind).bytes);
  }
}

}  // namespace

MessageCounts& MessageCounts::operator+=(const MessageCounts& more) {
  join_each(*this, more, [](std::int64_t& mine, std::int64_t other) { mine += other; });
  return *this;
}

MessageCounts& MessageCounts::operator-=(const MessageCounts& less) {
  join_each(*this, less, [](std::int64_t& mine, std::int64_t other) { mine -= other; });
  return *this;
}

const MessageCounts& message_counts() {
  return sent();
}

void MessageSummary::add(const Messages& of_a_rank) {
  count += of_a_rank.count;
  count_max = std::max(count_max, of_a_rank.count);
  bytes += of_a_rank.bytes;
  bytes_max = std::max(bytes_max, of_a_rank.bytes);
}

namespace session {

void count_message(Messages MessageCounts::*kind, std::uint64_t bytes) {
  Messages& messages = sent().*kind;
  ++messages.count;
  messages.bytes += static_cast<std::int64_t>(bytes);
}

void count_barrier(const CommunicatorHandle& group) {
  count_collective(group, 0);
}

void count_broadcast(const CommunicatorHandle& group, int root, std::uint64_t bytes) {
  const bool is_last = (group.rank + 1) % group.size == root;
  count_collective(group, is_last ? 0 : bytes);
}

void count_all_gather(const CommunicatorHandle& group, const std::vector<std::uint64_t>& bytes) {
  const auto next = static_cast<std::size_t>((group.rank + 1) % group.size);
  count_collective(group, std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0}) - bytes[next]);
}

void count_all_gather_of_equals(const CommunicatorHandle& group, std::uint64_t bytes) {
  count_collective(group, bytes * static_cast<std::uint64_t>(group.size - 1));
}

void count_gather(const CommunicatorHandle& group, int root, std::uint64_t bytes) {
  count_collective(group, group.rank == root ? 0 : bytes);
}

void count_reduction(const CommunicatorHandle& group, std::uint64_t bytes) {
  count_collective(group, bytes * values_sent_in_reduction(group.rank, group.size));
}

void count_scan(const CommunicatorHandle& group, std::uint64_t bytes) {
  count_collective(group, group.rank + 1 == group.size ? 0 : bytes);
}

void count_consensus(const CommunicatorHandle& group) {
  if (group.size > 1) count_message(&MessageCounts::rendezvous, 0);
}

}  // namespace session
}  // namespace aeroloom::parallel
