/// What vertices lie on: the values of mesh::Piece::vertex_dimension.
#pragma once

namespace aeroloom::mesh {

inline constexpr int at_vertex = 0, on_curve = 1, on_face = 2, in_region = 3;

}  // namespace aeroloom::mesh
