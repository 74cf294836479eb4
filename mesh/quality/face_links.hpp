/// Neighbours of cells over their faces, across pieces and ranks.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "mesh/data/piece_faces.hpp"
#include "mesh/exchange/delivery.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace aeroloom::mesh {

/// The cell on the other side of a face.
struct CellNeighbour {
  PieceId piece = -1;      ///< -1: none
  LocalIndex cell = -1;    ///< of that piece, all shapes counted
  std::int32_t side = -1;  ///< of that cell
  bool exists() const { return piece >= 0; }
  friend auto operator<=>(const CellNeighbour&, const CellNeighbour&) = default;
};

struct PieceLinks {
  std::vector<CellNeighbour> neighbours;  ///< by side (first_side)
  std::vector<LocalIndex> boundary_face;  ///< by side: the piece's boundary face there, -1 none
};

/// Faces that do not fit; counts over all ranks, the same everywhere.
struct LinkDefects {
  GlobalIndex crowded_faces = 0;   ///< at which more than two cells meet
  GlobalIndex stray_faces = 0;     ///< boundary faces that are no face of a cell of their piece
  GlobalIndex repeated_faces = 0;  ///< boundary faces where there is another one
  GlobalIndex open_faces = 0;      ///< faces of one cell alone without a boundary face
};

struct FaceLinks {
  std::vector<PieceLinks> pieces;  ///< in the order of mesh.pieces
  LinkDefects defects;
};

/// Matches the faces of all cells by the numbers of their vertices; only sides that find no other cell in
/// their piece travel. Takes 16 bytes a side: the checks of mesh/checks/validity.hpp do without. Collective.
FaceLinks link_faces(const NumberedMesh& mesh);

/// Something that a cell, or its piece, is told.
template <parallel::Flat T>
struct Told {
  CellNeighbour cell;
  T what;
};
/// Takes what cells are told to where they live. Returns what those of this rank are told, by cell and side.
/// Collective.
template <parallel::Flat T>
std::vector<Told<T>> tell_cells(const DistributedMesh& mesh, std::vector<Told<T>> words) {
  const parallel::Communicator& communicator = mesh.communicator;
  const std::vector<parallel::Rank> rank_of =
      gather_by_piece(mesh, std::vector<parallel::Rank>(mesh.pieces.size(), communicator.rank()));
  words = deliver(communicator, std::move(words),
                  [&](const Told<T>& word) { return rank_of[static_cast<std::size_t>(word.cell.piece)]; });
  std::sort(words.begin(), words.end(), [](const Told<T>& a, const Told<T>& b) { return a.cell < b.cell; });
  return words;
}

}  // namespace aeroloom::mesh
