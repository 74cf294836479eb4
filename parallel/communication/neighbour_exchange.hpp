/// Repeated exchange between the same ranks: partners and numbers of items are fixed once.
#pragma once

#include "parallel/communication/communicator.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace aeroloom::parallel {

/// How many items go to, or come from, another rank.
struct PartnerItems {
  Rank rank = 0;
  std::size_t items = 0;
};

/// Sends items to several ranks and receives items from them, in the order of the partner lists. Only
/// partners communicate: one message each way, in parts of at most 2^26 bytes.
class NeighbourExchange {
public:
  /// Precondition: if this rank sends n > 0 items to another rank, that rank lists n items from this one. A
  /// list has each rank at most once, and not this rank. Throws std::logic_error on all ranks if the sums
  /// differ, and on one rank if a partner is not another rank. Collective.
  NeighbourExchange(const Communicator& communicator, std::vector<PartnerItems> sends,
                    std::vector<PartnerItems> receives);
  /// An exchange of no items.
  static NeighbourExchange among_none(const Communicator& communicator) {
    return NeighbourExchange(communicator);
  }

  /// Sends `out` and fills `in`. Items have the same size on all ranks. Throws std::logic_error unless `out`
  /// and `in` hold exactly the items that this rank sends and receives. Collective.
  void exchange(std::span<const std::byte> out, std::span<std::byte> in) const;
  template <Flat T>
  void exchange(std::span<const T> out, std::span<T> in) const {
    if constexpr (is_exact<T>) {
      exchange(std::as_bytes(out), std::as_writable_bytes(in));
    } else {
      Bytes arrived(in.size() * wire_size<T>);
      exchange(to_bytes(out), std::span<std::byte>(arrived));
      read_items(arrived.data(), in);
    }
  }

  /// The exchange in the opposite direction.
  NeighbourExchange reversed() const;

private:
  explicit NeighbourExchange(const Communicator& communicator) : _communicator(communicator) {}

  Communicator _communicator;
  std::vector<PartnerItems> _sends, _receives;
  std::size_t _sent_items = 0, _received_items = 0;
};

}  // namespace aeroloom::parallel
