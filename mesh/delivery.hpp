/// Delivery of flat items to ranks, and tables with one row per piece.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/collective_error.hpp"

#include <algorithm>
#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::mesh {

/// Sends each item to the rank `destination(item)` and returns what arrives here, in ascending rank of the
/// sender and in the sender's order. Whoever uses the result sorts it by content: the order depends on ranks.
/// What stays on its rank is not packed, and what was sent is freed before the result is put together: move
/// the items in where they are not needed any more. Collective.
template <parallel::Transferable T, class Destination>
std::vector<T> deliver(const parallel::Communicator& communicator, std::vector<T> items,
                       const Destination& destination) {
  if (communicator.size() == 1) return items;
  const parallel::Rank here = communicator.rank();
  std::vector<std::size_t> counts(communicator.size(), 0);
  for (const T& item : items) ++counts[destination(item)];
  std::vector<parallel::Parcel> parcels;
  std::vector<std::size_t> parcel_of(counts.size(), 0);
  for (std::size_t rank = 0; rank < counts.size(); ++rank) {
    if (counts[rank] == 0 || static_cast<parallel::Rank>(rank) == here) continue;
    parcel_of[rank] = parcels.size();
    parcels.push_back({static_cast<parallel::Rank>(rank), parallel::Bytes(counts[rank] * sizeof(T))});
  }
  std::fill(counts.begin(), counts.end(), 0);
  std::size_t kept = 0;
  for (const T& item : items) {
    const auto rank = destination(item);
    if (rank == here) {
      items[kept++] = item;
    } else {
      std::memcpy(parcels[parcel_of[rank]].content.data() + counts[rank]++ * sizeof(T), &item, sizeof(T));
    }
  }
  items.resize(kept);
  items.shrink_to_fit();
  std::vector<parallel::Parcel> arrived = communicator.exchange(std::move(parcels));
  std::size_t total = kept;
  for (const auto& parcel : arrived) total += parcel.content.size() / sizeof(T);
  std::vector<T> result(total);
  auto* to = reinterpret_cast<std::byte*>(result.data());
  const auto append = [&to](const void* from, std::size_t bytes) {
    if (bytes > 0) std::memcpy(to, from, bytes);
    to += bytes;
  };
  std::size_t next = 0;
  const auto append_parcels = [&](parallel::Rank end) {
    for (; next < arrived.size() && arrived[next].rank < end; ++next) {
      append(arrived[next].content.data(), arrived[next].content.size());
      parallel::Bytes().swap(arrived[next].content);
    }
  };
  append_parcels(here);
  append(items.data(), kept * sizeof(T));
  append_parcels(communicator.size());
  return result;
}

/// The rows of all pieces by piece id, on every rank. `rows` has one entry per local piece, in the order of
/// mesh.pieces. Throws CollectiveError when the pieces of all ranks are not exactly 0 .. piece_count - 1.
/// Collective.
template <parallel::Transferable Row>
std::vector<Row> gather_by_piece(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                                 const std::vector<Row>& rows) {
  struct Tagged {
    Row row;
    PieceId piece;
  };
  std::vector<Tagged> mine(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) mine[i] = {rows[i], mesh.pieces[i].id};
  std::vector<Tagged> all = communicator.all_gather_items(std::span<const Tagged>(mine));
  std::sort(all.begin(), all.end(), [](const Tagged& a, const Tagged& b) { return a.piece < b.piece; });
  bool complete = all.size() == static_cast<std::size_t>(mesh.piece_count);
  for (std::size_t i = 0; complete && i < all.size(); ++i) complete = all[i].piece == static_cast<PieceId>(i);
  if (!complete) {
    throw parallel::CollectiveError(parallel::FailureKind::bug, "the ranks do not hold each of the mesh's " +
                                                                    std::to_string(mesh.piece_count) +
                                                                    " pieces exactly once");
  }
  std::vector<Row> table(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) table[i] = all[i].row;
  return table;
}

}  // namespace aeroloom::mesh
