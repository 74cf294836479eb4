/// Which piece gets which tetrahedron of a replaced cavity. Used by rounds.cpp.
#pragma once

#include "improve/borders/rounds.hpp"

#include <vector>

namespace aeroloom::cavities {

struct CavityAssignment {
  std::vector<mesh::PieceId> of_tet;       ///< per tetrahedron of the content
  std::vector<mesh::PieceId> of_triangle;  ///< per triangle of the surface mesh: that of its tetrahedron
};

/// Each piece that gave to the cavity takes what is nearest to the part of the cavity's boundary it gave, in
/// steps from tetrahedron to tetrahedron; so it stays about as large as it was. `donor`: per old tetrahedron.
CavityAssignment assign_to_pieces(const Cavity& cavity, const std::vector<mesh::PieceId>& donor,
                                  const CavityContent& content);

}  // namespace aeroloom::cavities
