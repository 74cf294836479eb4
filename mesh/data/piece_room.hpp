/// Memory of pieces.
#pragma once

#include "mesh/data/piece.hpp"

namespace aeroloom::mesh {

/// Gives back what the arrays have reserved in vain: pieces rest for long.
inline void shrink_to_fit(Piece& piece) {
  piece.coordinates.shrink_to_fit();
  piece.cells.shrink_to_fit();
  piece.vertex_dimension.shrink_to_fit();
  piece.vertex_entity.shrink_to_fit();
  piece.shared_vertices.shrink_to_fit();
  piece.shared_keys.shrink_to_fit();
}

}  // namespace aeroloom::mesh
