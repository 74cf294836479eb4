/// Assignment of the new tetrahedra of a cavity to pieces. Used by rounds.cpp.
#pragma once

#include "improve/borders/rounds.hpp"

#include <vector>

namespace aeroloom::cavities {

struct CavityAssignment {
  std::vector<mesh::PieceId> of_tet;       ///< per new tetrahedron
  std::vector<mesh::PieceId> of_triangle;  ///< per triangle of the surface mesh, as its tetrahedron
};

/// Assigns each new tetrahedron to one of the pieces that had tetrahedra in the cavity. It goes to the piece
/// whose part of the cavity boundary is nearest, in steps across faces. So pieces keep about their size.
/// `donor`: the piece of each old tetrahedron.
CavityAssignment assign_to_pieces(const Cavity& cavity, const std::vector<mesh::PieceId>& donor,
                                  const CavityContent& content);

}  // namespace aeroloom::cavities
