/// The communicator: ranks, typed collectives and sparse exchange. Hides the message passing library (MPI),
/// with its counts and displacements.
#pragma once

#include "parallel/communication/packer.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::parallel {

using Rank = int;

/// The bytes that a sparse exchange sends to, or receives from, one rank.
struct Parcel {
  Rank rank;
  Bytes content;
};

struct CommunicatorHandle;

/// A group of ranks. Cheap to copy; copies refer to the same group. Every member function except rank(),
/// size() and is_root() is collective over the group. Messages may be longer than 2^31 bytes. A failure of
/// MPI throws std::runtime_error.
class Communicator {
public:
  /// No group: every member function throws std::logic_error.
  Communicator() = default;
  /// All ranks of the program. Throws std::logic_error without a living Environment.
  static Communicator world();
  /// This rank alone. Throws std::logic_error unless MPI runs. For the host's own groups see host.hpp.
  static Communicator self();
  /// Internal to parallel/.
  explicit Communicator(std::shared_ptr<CommunicatorHandle> handle) : _handle(std::move(handle)) {}

  Rank rank() const;
  int size() const;
  bool is_root() const { return rank() == 0; }

  void barrier() const;
  /// Replaces `bytes` on every rank by those of `root`.
  void broadcast(Bytes& bytes, Rank root = 0) const;
  /// One entry per rank, in rank order, on every rank.
  std::vector<Bytes> all_gather(const Bytes& mine) const;
  /// One entry per rank, in rank order, on `root`; empty elsewhere.
  std::vector<Bytes> gather(const Bytes& mine, Rank root = 0) const;
  /// Sends each parcel to its rank. Returns the parcels sent to this rank, in ascending rank of the sender.
  /// Only ranks with parcels for each other exchange messages; the receivers learn of them by the
  /// non-blocking consensus of Hoefler, Siebert, Lumsdaine (PPoPP 2010, doi:10.1145/1693453.1693476).
  /// Throws std::logic_error for a second parcel to the same rank, or for a rank that does not exist.
  std::vector<Parcel> exchange(std::vector<Parcel> outgoing) const;

  std::int64_t sum(std::int64_t value) const;
  std::int64_t minimum(std::int64_t value) const;
  std::int64_t maximum(std::int64_t value) const;
  /// Sum of the values of lower ranks; 0 on rank 0.
  std::int64_t exclusive_scan(std::int64_t value) const;
  double minimum(double value) const;
  double maximum(double value) const;
  /// Replaces each value by the sum, or the smallest, of the values at this place on all ranks. All ranks
  /// pass equally many.
  void sum_each(std::span<std::int64_t> values) const;
  void minimum_each(std::span<double> values) const;
  /// Sum in rank order, the same bits on every rank for the same number of ranks. The bits depend on how
  /// values are spread over ranks: never feed it into a mesh.
  double sum(double value) const;

  /// Concatenation of every rank's items in rank order, on every rank.
  template <Flat T>
  std::vector<T> all_gather_items(std::span<const T> mine) const;
  /// As all_gather_items, then sorted by key(item), where `key` is a member or a function. If all keys
  /// differ, the order does not depend on the number of ranks.
  template <Flat T, class Key = std::identity>
  std::vector<T> gather_sorted(const std::vector<T>& mine, const Key& key = {}) const;
  template <Flat T>
  void broadcast_items(std::vector<T>& items, Rank root = 0) const;

  /// As broadcast, gather and all_gather, for any type that can be packed (packer.hpp).
  template <class T>
  void broadcast_value(T& value, Rank root = 0) const;
  template <class T>
  std::vector<T> gather_values(const T& mine, Rank root = 0) const;
  template <class T>
  std::vector<T> all_gather_values(const T& mine) const;

private:
  friend class NodeMemory;
  friend struct HostAccess;
  const CommunicatorHandle& handle() const;
  /// While MPI runs.
  const CommunicatorHandle& usable_handle() const;
  /// The number of bytes on each rank.
  std::vector<std::uint64_t> all_sizes(std::uint64_t mine) const;
  /// Writes the bytes of all ranks to `to`, in rank order; `sizes` are their numbers.
  void all_gather_into(std::span<const std::byte> mine, const std::vector<std::uint64_t>& sizes,
                       std::byte* to) const;
  std::shared_ptr<CommunicatorHandle> _handle;
};

}  // namespace aeroloom::parallel

#include "parallel/communication/communicator_items.hpp"
