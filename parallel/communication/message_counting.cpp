#include "parallel/communication/message_counting.hpp"

#include "parallel/communication/fields.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <tuple>

namespace aeroloom::parallel {
namespace {

MessageCounts& sent() {
  static MessageCounts instance;
  return instance;
}

ExchangeCounts& exchanged() {
  static ExchangeCounts instance;
  return instance;
}

void count_collective(const CommunicatorHandle& group, std::uint64_t bytes) {
  if (group.size > 1) session::count_message(&MessageCounts::collective, bytes);
}

/// Values that a rank sends while all ranks reduce one each. Ranks beyond a power of two hand their value to
/// a neighbour, which takes part for them and tells them the result.
std::uint64_t values_sent_in_reduction(int rank, int ranks) {
  const int doubling = static_cast<int>(std::bit_floor(static_cast<unsigned>(ranks)));
  const int excess = ranks - doubling;
  const auto steps = static_cast<std::uint64_t>(std::countr_zero(static_cast<unsigned>(doubling)));
  if (rank >= 2 * excess) return steps;
  return rank % 2 == 0 ? 1 : steps + 1;
}

/// Calls join(number, other number) for each number of both.
template <class Counts, class Join>
void join_each(Counts& counts, const Counts& others, Join join) {
  std::apply(
      [&](auto&... mine) {
        std::apply(
            [&](const auto&... theirs) {
              (join(mine.count, theirs.count), ...);
              (join(mine.bytes, theirs.bytes), ...);
            },
            fields_of(others));
      },
      fields_of(counts));
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

ExchangeCounts& ExchangeCounts::operator+=(const ExchangeCounts& more) {
  join_each(*this, more, [](std::int64_t& mine, std::int64_t other) { mine += other; });
  return *this;
}

ExchangeCounts& ExchangeCounts::operator-=(const ExchangeCounts& less) {
  join_each(*this, less, [](std::int64_t& mine, std::int64_t other) { mine -= other; });
  return *this;
}

void ExchangeCounts::join(const ExchangeCounts& of_a_rank) {
  const std::array<std::int64_t, 3> added{gather.bytes + of_a_rank.gather.bytes,
                                          neighbour.bytes + of_a_rank.neighbour.bytes,
                                          rendezvous.bytes + of_a_rank.rendezvous.bytes};
  join_each(*this, of_a_rank, [](std::int64_t& mine, std::int64_t other) { mine = std::max(mine, other); });
  gather.bytes = added[0];
  neighbour.bytes = added[1];
  rendezvous.bytes = added[2];
}

const ExchangeCounts& exchange_counts() {
  return exchanged();
}

void note_kept(std::uint64_t bytes) {
  exchanged().rendezvous.bytes += static_cast<std::int64_t>(bytes);
}

void note_spared_rendezvous(std::uint64_t bytes) {
  session::count_exchange(&ExchangeCounts::rendezvous, bytes);
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

void count_exchange(Messages ExchangeCounts::*kind, std::uint64_t bytes) {
  Messages& messages = exchanged().*kind;
  ++messages.count;
  messages.bytes += static_cast<std::int64_t>(bytes);
}

void count_barrier(const CommunicatorHandle& group) {
  count_exchange(&ExchangeCounts::reduction, 0);
  count_collective(group, 0);
}

void count_broadcast(const CommunicatorHandle& group, int root, std::uint64_t bytes) {
  count_exchange(&ExchangeCounts::broadcast, bytes);
  const bool is_last = (group.rank + 1) % group.size == root;
  count_collective(group, is_last ? 0 : bytes);
}

void count_all_gather(const CommunicatorHandle& group, const std::vector<std::uint64_t>& bytes) {
  const auto next = static_cast<std::size_t>((group.rank + 1) % group.size);
  const std::uint64_t joint = std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
  count_exchange(&ExchangeCounts::all_gather, joint);
  count_collective(group, joint - bytes[next]);
}

void count_all_gather_of_equals(const CommunicatorHandle& group, std::uint64_t bytes) {
  count_exchange(&ExchangeCounts::table, bytes);
  count_collective(group, bytes * static_cast<std::uint64_t>(group.size - 1));
}

void count_gather(const CommunicatorHandle& group, int root, std::uint64_t bytes) {
  count_exchange(&ExchangeCounts::gather, bytes);
  count_collective(group, group.rank == root ? 0 : bytes);
}

void count_reduction(const CommunicatorHandle& group, std::uint64_t bytes) {
  count_exchange(&ExchangeCounts::reduction, bytes);
  count_collective(group, bytes * values_sent_in_reduction(group.rank, group.size));
}

void count_scan(const CommunicatorHandle& group, std::uint64_t bytes) {
  count_exchange(&ExchangeCounts::reduction, bytes);
  count_collective(group, group.rank + 1 == group.size ? 0 : bytes);
}

void count_consensus(const CommunicatorHandle& group) {
  if (group.size > 1) count_message(&MessageCounts::rendezvous, 0);
}

}  // namespace session
}  // namespace aeroloom::parallel
