/// How many messages ranks send each other, and how many bytes.
#pragma once

#include <cstdint>

namespace aeroloom::parallel {

/// Messages of one kind that this rank has sent to other ranks. Bytes are those of the content, without the
/// headers of protocols. A group of one rank sends nothing, and counts nothing.
struct Messages {
  std::int64_t count = 0, bytes = 0;
  friend bool operator==(const Messages&, const Messages&) = default;
};

/// By kind. Summed over ranks the bytes are what goes through the network where each rank has a host of its
/// own:
/// - collective: count is the operations of the library this rank took part in. Sizes that go ahead are an
///   operation of their own, and so is each part of 2^26 bytes. Bytes are those of the usual algorithms: of n
///   bytes broadcast in a group of P each rank but the last of the chain that starts at the root sends n; an
///   all_gather goes round a ring, each rank passes on all but what its next one had; reductions double the
///   distance, log2 P values from each rank where P is a power of two; a scan goes from rank to rank; what is
///   gathered goes to the root once; a barrier has no bytes.
/// - neighbour: messages of NeighbourExchange, in parts of at most 2^26 bytes.
/// - rendezvous: Communicator::exchange, once for the consensus, which has no bytes, and for each parcel that
///   leaves the rank the announcement, of 8 bytes, and the content, in parts.
/// Not counted: what ranks of a node exchange among themselves (NodeArray), and what the library sends to
/// open and close files and to make groups.
struct MessageCounts {
  Messages collective, neighbour, rendezvous;
  friend bool operator==(const MessageCounts&, const MessageCounts&) = default;
  MessageCounts& operator+=(const MessageCounts& more);
  MessageCounts& operator-=(const MessageCounts& less);
};

/// All that this process has sent so far.
const MessageCounts& message_counts();

/// Exchanges that were asked for, in a group of one rank as of many: a model of other numbers of ranks goes
/// by them. Counts are calls, on every rank the same but where it says so.
struct ExchangeCounts {
  Messages broadcast;   ///< bytes of the content
  Messages all_gather;  ///< bytes of all ranks together
  Messages table;       ///< gathered on all ranks, from each rank equally many bytes: these
  Messages gather;      ///< on one rank; bytes of this rank
  Messages reduction;   ///< scans and barriers too; bytes of one value
  Messages neighbour;   ///< exchanges of this rank, and what it handed over to others
  Messages rendezvous;  ///< bytes this rank handed over, what it has for itself included
  friend bool operator==(const ExchangeCounts&, const ExchangeCounts&) = default;
  ExchangeCounts& operator+=(const ExchangeCounts& more);
  ExchangeCounts& operator-=(const ExchangeCounts& less);
  /// Of another rank: what is of all ranks is kept, the largest where ranks differ; what is of one is added.
  void join(const ExchangeCounts& of_a_rank);
};

/// All of this process so far.
const ExchangeCounts& exchange_counts();
/// Counts what stays on this rank of something distributed by rendezvous, and is not handed over.
void note_kept(std::uint64_t bytes);
/// Counts what a rendezvous would send that is spared, since there is one rank.
void note_spared_rendezvous(std::uint64_t bytes);

/// Messages of one kind over all ranks: of all together, and of the rank that has most of them.
struct MessageSummary {
  std::int64_t count = 0, count_max = 0, bytes = 0, bytes_max = 0;

  void add(const Messages& of_a_rank);
};

}  // namespace aeroloom::parallel
