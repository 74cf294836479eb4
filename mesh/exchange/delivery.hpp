/// Delivery of flat items to ranks (parallel/communication/deliver.hpp), and tables with one row per piece.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/deliver.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace aeroloom::mesh {

using parallel::deliver;

/// The rows of all pieces by piece id, on every rank. `rows` has one entry per local piece, in the order of
/// mesh.pieces. Throws CollectiveError when the pieces of all ranks are not exactly 0 .. piece_count - 1.
/// Collective.
template <parallel::Flat Row>
std::vector<Row> gather_by_piece(const DistributedMesh& mesh, const std::vector<Row>& rows) {
  const parallel::Communicator& communicator = mesh.communicator;
  struct Tagged {
    Row row;
    PieceId piece;
  };
  std::vector<Tagged> mine(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) mine[i] = {rows[i], mesh.pieces[i].id};
  std::vector<Tagged> all = communicator.gather_sorted(mine, &Tagged::piece);
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

/// Sums over the pieces of lower id, per local piece; the total comes last. `counts` as
/// rows of gather_by_piece. Collective.
inline std::vector<GlobalIndex> first_by_piece(const DistributedMesh& mesh,
                                               const std::vector<GlobalIndex>& counts) {
  std::vector<GlobalIndex> first(1, 0);
  for (const GlobalIndex count : gather_by_piece(mesh, counts)) first.push_back(first.back() + count);
  std::vector<GlobalIndex> result;
  for (const Piece& piece : mesh.pieces) result.push_back(first[piece.id]);
  result.push_back(first.back());
  return result;
}

}  // namespace aeroloom::mesh
