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
/// Collective.
template <parallel::Transferable T, class Destination>
std::vector<T> deliver(const parallel::Communicator& communicator, const std::vector<T>& items,
                       const Destination& destination) {
  std::vector<std::size_t> counts(communicator.size(), 0);
  for (const T& item : items) ++counts[destination(item)];
  std::vector<parallel::Parcel> parcels;
  std::vector<std::size_t> parcel_of(counts.size(), 0);
  for (std::size_t rank = 0; rank < counts.size(); ++rank) {
    if (counts[rank] == 0) continue;
    parcel_of[rank] = parcels.size();
    parcels.push_back({static_cast<parallel::Rank>(rank), parallel::Bytes(counts[rank] * sizeof(T))});
  }
  std::fill(counts.begin(), counts.end(), 0);
  for (const T& item : items) {
    const auto rank = destination(item);
    std::memcpy(parcels[parcel_of[rank]].content.data() + counts[rank]++ * sizeof(T), &item, sizeof(T));
  }
  const std::vector<parallel::Parcel> arrived = communicator.exchange(std::move(parcels));
  std::size_t bytes = 0;
  for (const auto& parcel : arrived) bytes += parcel.content.size();
  std::vector<T> result(bytes / sizeof(T));
  auto* to = reinterpret_cast<std::byte*>(result.data());
  for (const auto& parcel : arrived) {
    std::memcpy(to, parcel.content.data(), parcel.content.size());
    to += parcel.content.size();
  }
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
