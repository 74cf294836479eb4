/// Which vertices' stars a round of cavities takes. Used by rounds.cpp.
#pragma once

#include "cavities/rounds.hpp"

namespace aeroloom::cavities {

/// All pieces wish the same for shared vertices: the highest. Collective.
void spread_wishes(const mesh::SharedVertices& shared, CavityWishes& wishes);

/// Withdraws wishes of vertices with a neighbour in another cavity, in any piece. Collective.
void settle_wishes(const mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                   CavityWishes& wishes);

/// Adds the inner vertices next to each cavity, those on the surface too where asked for: to it, if they are
/// next to no other.
void widen(const mesh::Piece& piece, bool along_surface, std::vector<CavityId>& wishes);

/// The first wish among vertices.
inline CavityId cavity_of(const std::vector<CavityId>& wishes, const mesh::LocalIndex* vertices, int count) {
  for (int k = 0; k < count; ++k) {
    if (wishes[vertices[k]] != no_cavity) return wishes[vertices[k]];
  }
  return no_cavity;
}

}  // namespace aeroloom::cavities
