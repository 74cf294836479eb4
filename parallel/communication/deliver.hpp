/// Delivery of flat items to the ranks that need them.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/communication/message_counts.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::parallel {

/// Sends each item to the rank `destination(item)`. Returns the items received, in ascending rank of the
/// sender and in the sender's order. This order depends on the number of ranks, so callers sort the result by
/// content. Items that stay on their rank are not packed. Sent items are freed before the result is made:
/// callers move the items in to save memory. Collective.
template <Flat T, class Destination>
std::vector<T> deliver(const Communicator& communicator, std::vector<T> items,
                       const Destination& destination) {
  constexpr std::size_t item_bytes = wire_size<T>;
  if (communicator.size() == 1) {
    note_spared_rendezvous(items.size() * item_bytes);
    return items;
  }
  const Rank here = communicator.rank();
  std::vector<std::size_t> counts(communicator.size(), 0);
  for (const T& item : items) ++counts[destination(item)];
  std::vector<Parcel> parcels;
  std::vector<std::size_t> parcel_of(counts.size(), 0);
  for (std::size_t rank = 0; rank < counts.size(); ++rank) {
    if (counts[rank] == 0 || static_cast<Rank>(rank) == here) continue;
    parcel_of[rank] = parcels.size();
    parcels.push_back({static_cast<Rank>(rank), Bytes(counts[rank] * item_bytes)});
  }
  std::fill(counts.begin(), counts.end(), 0);
  std::size_t kept = 0;
  for (const T& item : items) {
    const auto rank = destination(item);
    if (rank == here) {
      items[kept++] = item;
    } else {
      write_item(item, parcels[parcel_of[rank]].content.data() + counts[rank]++ * item_bytes);
    }
  }
  note_kept(kept * item_bytes);
  items.resize(kept);
  items.shrink_to_fit();
  std::vector<Parcel> arrived = communicator.exchange(std::move(parcels));
  std::size_t total = kept;
  for (const auto& parcel : arrived) total += parcel.content.size() / item_bytes;
  std::vector<T> result(total);
  std::span<T> to(result);
  std::size_t next = 0;
  const auto append_parcels = [&](Rank end) {
    for (; next < arrived.size() && arrived[next].rank < end; ++next) {
      Bytes& content = arrived[next].content;
      const std::size_t count = content.size() / item_bytes;
      read_items(content.data(), to.first(count));
      to = to.subspan(count);
      Bytes().swap(content);
    }
  };
  append_parcels(here);
  std::copy(items.begin(), items.end(), to.begin());
  to = to.subspan(kept);
  append_parcels(communicator.size());
  return result;
}

}  // namespace aeroloom::parallel
