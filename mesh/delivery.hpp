/// Delivery of flat items to ranks, and tables with one row per piece.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/collective_error.hpp"
#include "parallel/message_counts.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::mesh {

/// Sends each item to the rank `destination(item)` and returns what arrives here, in ascending rank of the
/// sender and in the sender's order. Whoever uses the result sorts it by content: the order depends on ranks.
/// What stays on its rank is not packed, and what was sent is freed before the result is put together: move
/// the items in where they are not needed any more. Collective.
template <parallel::Flat T, class Destination>
std::vector<T> deliver(const parallel::Communicator& communicator, std::vector<T> items,
                       const Destination& destination) {
  constexpr std::size_t item_bytes = parallel::wire_size<T>;
  if (communicator.size() == 1) {
    parallel::note_spared_rendezvous(items.size() * item_bytes);
    return items;
  }
  const parallel::Rank here = communicator.rank();
  std::vector<std::size_t> counts(communicator.size(), 0);
  for (const T& item : items) ++counts[destination(item)];
  std::vector<parallel::Parcel> parcels;
  std::vector<std::size_t> parcel_of(counts.size(), 0);
  for (std::size_t rank = 0; rank < counts.size(); ++rank) {
    if (counts[rank] == 0 || static_cast<parallel::Rank>(rank) == here) continue;
    parcel_of[rank] = parcels.size();
    parcels.push_back({static_cast<parallel::Rank>(rank), parallel::Bytes(counts[rank] * item_bytes)});
  }
  std::fill(counts.begin(), counts.end(), 0);
  std::size_t kept = 0;
  for (const T& item : items) {
    const auto rank = destination(item);
    if (rank == here) {
      items[kept++] = item;
    } else {
      parallel::write_item(item, parcels[parcel_of[rank]].content.data() + counts[rank]++ * item_bytes);
    }
  }
  parallel::note_kept(kept * item_bytes);
  items.resize(kept);
  items.shrink_to_fit();
  std::vector<parallel::Parcel> arrived = communicator.exchange(std::move(parcels));
  std::size_t total = kept;
  for (const auto& parcel : arrived) total += parcel.content.size() / item_bytes;
  std::vector<T> result(total);
  std::span<T> to(result);
  std::size_t next = 0;
  const auto append_parcels = [&](parallel::Rank end) {
    for (; next < arrived.size() && arrived[next].rank < end; ++next) {
      parallel::Bytes& content = arrived[next].content;
      const std::size_t count = content.size() / item_bytes;
      parallel::read_items(content.data(), to.first(count));
      to = to.subspan(count);
      parallel::Bytes().swap(content);
    }
  };
  append_parcels(here);
  std::copy(items.begin(), items.end(), to.begin());
  to = to.subspan(kept);
  append_parcels(communicator.size());
  return result;
}

/// The rows of all pieces by piece id, on every rank. `rows` has one entry per local piece, in the order of
/// mesh.pieces. Throws CollectiveError when the pieces of all ranks are not exactly 0 .. piece_count - 1.
/// Collective.
template <parallel::Flat Row>
std::vector<Row> gather_by_piece(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                                 const std::vector<Row>& rows) {
  struct Tagged {
    Row row;
    PieceId piece;
    static constexpr auto fields() { return std::tuple(&Tagged::row, &Tagged::piece); }
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

/// The place in mesh.pieces of a piece that lives on this rank.
inline std::size_t position_of(const DistributedMesh& mesh, PieceId id) {
  const auto found = std::lower_bound(mesh.pieces.begin(), mesh.pieces.end(), id,
                                      [](const Piece& piece, PieceId wanted) { return piece.id < wanted; });
  return static_cast<std::size_t>(found - mesh.pieces.begin());
}

/// What the pieces of lower id have of something together, per local piece; the total comes last. `counts` as
/// rows of gather_by_piece. Collective.
inline std::vector<GlobalIndex> first_by_piece(const parallel::Communicator& communicator,
                                               const DistributedMesh& mesh,
                                               const std::vector<GlobalIndex>& counts) {
  std::vector<GlobalIndex> first(1, 0);
  for (const GlobalIndex count : gather_by_piece(communicator, mesh, counts))
    first.push_back(first.back() + count);
  std::vector<GlobalIndex> result;
  for (const Piece& piece : mesh.pieces) result.push_back(first[piece.id]);
  result.push_back(first.back());
  return result;
}

}  // namespace aeroloom::mesh
