/// Exchange between ranks that know each other: who sends how much to whom is found out once.
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

/// Items for several ranks, one partner's after the other's in the order of `sends`, and likewise received.
/// No rank looks for messages it does not know of, and only partners communicate: one message each way, in
/// parts where it is longer than 2^26 bytes.
class NeighbourExchange {
public:
  /// Sender and receiver know of each other: where this rank sends n > 0 items to another one, that one
  /// receives n from this one. No rank twice in a list, and not this one. Throws std::logic_error, on all
  /// ranks, when the sums do not fit; on one when a partner is no other rank. Collective.
  NeighbourExchange(const Communicator& communicator, std::vector<PartnerItems> sends,
                    std::vector<PartnerItems> receives);
  /// One in which nobody has anything for anyone.
  static NeighbourExchange among_none(const Communicator& communicator) {
    return NeighbourExchange(communicator);
  }

  /// Sends `out` and fills `in`. Items are of one size, the same on all ranks: `out` and `in` hold whole
  /// ones, as many as this rank sends and receives, else std::logic_error is thrown. Collective.
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

  /// The exchange the other way round: what was sent is received.
  NeighbourExchange reversed() const;

private:
  explicit NeighbourExchange(const Communicator& communicator) : _communicator(communicator) {}

  Communicator _communicator;
  std::vector<PartnerItems> _sends, _receives;
  std::size_t _sent_items = 0, _received_items = 0;
};

}  // namespace aeroloom::parallel
