/// What lies behind the faces of cells, across pieces and ranks.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "mesh/piece_faces.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::mesh {

/// The other cell at a side.
struct CellBehind {
  PieceId piece = -1;      ///< -1: none
  LocalIndex cell = -1;    ///< of that piece, all shapes counted
  std::int32_t side = -1;  ///< of that cell

  static constexpr auto fields() {
    return std::tuple(&CellBehind::piece, &CellBehind::cell, &CellBehind::side);
  }
  bool exists() const { return piece >= 0; }
};

struct PieceLinks {
  std::vector<CellBehind> behind;         ///< by side (first_side)
  std::vector<LocalIndex> boundary_face;  ///< by side: the piece's boundary face there, -1 none
};

/// What does not fit; counts over all ranks, the same everywhere.
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
/// their piece travel. Takes 16 bytes a side: the checks of mesh/validity.hpp do without. Collective.
FaceLinks link_faces(const parallel::Communicator& communicator, const DistributedMesh& mesh,
                     const Numbering& numbering);

}  // namespace aeroloom::mesh
