/// The vertices and triangles of the layer cap over a piece of the wall.
#pragma once

#include "layers/columns.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// Follows from the wall and its columns. The ends of a vertex's columns are several vertices, unless they
/// are empty: then it is one. The lowest column that the piece has a triangle at takes the vertex's number;
/// others and the apexes over sectors come after all of these. The triangles of the wall come first, with
/// their numbers, then those over faces of fans, then those at the rims of planes.
struct CapLayout {
  std::vector<mesh::LocalIndex> vertex_of_column;          ///< -1: not in this piece
  std::vector<mesh::LocalIndex> apex_of_face;              ///< by face of a fan; -1: none
  std::vector<std::array<mesh::LocalIndex, 3>> triangles;  ///< all, as the wall's are oriented
  std::vector<std::int32_t> origins;  ///< by triangle beyond the wall's: its face of a fan; -1: of a rim
  std::vector<std::int32_t> column_of_vertex;  ///< -1: an apex
  mesh::LocalIndex vertex_count = 0;
};
CapLayout lay_out_cap(const mesh::Piece& wall, const PieceColumns& columns);

}  // namespace aeroloom::layers
