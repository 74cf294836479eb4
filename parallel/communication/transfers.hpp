/// Messages of any size between two ranks. Internal to parallel/.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/communication/message_counting.hpp"
#include "parallel/communication/session.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace aeroloom::parallel {

/// Counts of the library are 32-bit: longer messages travel in parts of this many bytes. Joint messages of
/// several ranks above it go one rank after the other.
inline constexpr std::size_t largest_part = std::size_t{1} << 26;

/// Tags of our own messages. Those of consensus alternate between the first and the one after it.
inline constexpr int tag_content = 1;
inline constexpr int tag_consensus = 2;
inline constexpr int tag_neighbours = 4;

/// Calls `transfer(offset, count)` for each part of a message.
template <class Transfer>
void for_each_part(std::size_t total, Transfer transfer) {
  for (std::size_t offset = 0; offset < total; offset += largest_part) {
    transfer(offset, static_cast<int>(std::min(largest_part, total - offset)));
  }
}

/// Messages under way; parts between the same two ranks stay in order. What is sent, and the room for what is
/// received, must live until wait() returns.
class Transfers {
public:
  /// Messages count as those of `kind`.
  Transfers(MPI_Comm communicator, int tag, Messages MessageCounts::*kind)
      : _communicator(communicator), _tag(tag), _kind(kind) {}

  void send(std::span<const std::byte> bytes, Rank to) {
    for_each_part(bytes.size(), [&](std::size_t offset, int count) {
      session::check(MPI_Isend(bytes.data() + offset, count, MPI_BYTE, to, _tag, _communicator, &add()),
                     "sending");
      session::count_message(_kind, static_cast<std::uint64_t>(count));
    });
  }
  void receive(std::span<std::byte> bytes, Rank from) {
    for_each_part(bytes.size(), [&](std::size_t offset, int count) {
      session::check(MPI_Irecv(bytes.data() + offset, count, MPI_BYTE, from, _tag, _communicator, &add()),
                     "receiving");
    });
  }
  void wait() {
    session::check(MPI_Waitall(static_cast<int>(_requests.size()), _requests.data(), MPI_STATUSES_IGNORE),
                   "waiting for messages");
    _requests.clear();
  }

private:
  MPI_Request& add() { return _requests.emplace_back(MPI_REQUEST_NULL); }

  MPI_Comm _communicator;
  int _tag;
  Messages MessageCounts::*_kind;
  std::vector<MPI_Request> _requests;
};

}  // namespace aeroloom::parallel
