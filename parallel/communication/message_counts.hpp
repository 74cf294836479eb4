/// How many messages ranks send each other, and how many bytes.
#pragma once

#include <cstdint>

namespace aeroloom::parallel {

/// Messages of one kind that this rank has sent to other ranks. Bytes are those of the content, without
/// protocol headers. A group of one rank sends no messages.
struct Messages {
  std::int64_t count = 0, bytes = 0;
  friend bool operator==(const Messages&, const Messages&) = default;
};

/// Messages by kind. The sum of bytes over ranks is the network traffic if each rank has its own host.
/// - collective: the count is the number of MPI operations. A gather of sizes counts by itself, and so does
///   each part of 2^26 bytes. Bytes are those of the usual algorithms on P ranks. Broadcast: a chain from the
///   root, where all ranks but the last send the content. All-gather: a ring, where each rank passes on all
///   but the content of its next rank. Reduction: recursive doubling, log2 P values from each rank if P is a
///   power of two. Scan: from rank to rank. Gather: each content once to the root. Barrier: no bytes.
/// - neighbour: messages of NeighbourExchange, in parts of at most 2^26 bytes.
/// - rendezvous: Communicator::exchange. It counts one consensus without bytes. For each parcel to another
///   rank it counts an announcement of 8 bytes and the content, in parts.
/// Not counted: exchange among the ranks of a node (NodeArray), and messages of MPI itself for opening and
/// closing files and for making groups.
struct MessageCounts {
  Messages collective, neighbour, rendezvous;
  friend bool operator==(const MessageCounts&, const MessageCounts&) = default;
  MessageCounts& operator+=(const MessageCounts& more);
  MessageCounts& operator-=(const MessageCounts& less);
};

/// All that this process has sent so far.
const MessageCounts& message_counts();

/// Exchanges that the program has called, on one rank as on many. The model of other numbers of ranks uses
/// them (pipeline/study/). Counts are calls; bytes are the same on every rank unless stated otherwise.
struct ExchangeCounts {
  Messages broadcast;   ///< bytes of the content
  Messages all_gather;  ///< bytes of all ranks together
  Messages table;       ///< all_gather of equally many bytes from each rank; bytes of one rank
  Messages gather;      ///< on one rank; bytes of this rank
  Messages reduction;   ///< scans and barriers too; bytes of one value
  Messages neighbour;   ///< calls of this rank; bytes that it sent
  Messages rendezvous;  ///< bytes from this rank, those to itself included
  friend bool operator==(const ExchangeCounts&, const ExchangeCounts&) = default;
  ExchangeCounts& operator+=(const ExchangeCounts& more);
  ExchangeCounts& operator-=(const ExchangeCounts& less);
  /// Joins the counts of another rank: adds bytes of single ranks, and keeps the larger of all other values.
  void join(const ExchangeCounts& of_a_rank);
};

/// All of this process so far.
const ExchangeCounts& exchange_counts();
/// Counts the bytes of a delivery (deliver.hpp) that stay on this rank.
void note_kept(std::uint64_t bytes);
/// Counts a delivery on one rank, which exchanges nothing.
void note_spared_rendezvous(std::uint64_t bytes);

/// Messages of one kind: the sum over all ranks, and the largest of a rank.
struct MessageSummary {
  std::int64_t count = 0, count_max = 0, bytes = 0, bytes_max = 0;

  void add(const Messages& of_a_rank);
};

}  // namespace aeroloom::parallel
