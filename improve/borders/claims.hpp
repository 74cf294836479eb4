/// Which vertices' stars a round of cavities takes. Used by rounds.cpp.
#pragma once

#include "improve/borders/rounds.hpp"

namespace aeroloom::cavities {

/// Withdraws claims of vertices with a neighbour in another cavity, in any piece. Collective.
void withdraw_contested_claims(const mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                               CavityClaims& claims);

/// Adds the inner vertices next to each cavity, those on the surface too where asked for: to it, if they are
/// next to no other.
void widen(const mesh::Piece& piece, bool along_surface, std::vector<CavityId>& claims);

/// The first claim among vertices.
inline CavityId cavity_of(const std::vector<CavityId>& claims, const mesh::LocalIndex* vertices, int count) {
  for (int k = 0; k < count; ++k) {
    if (claims[vertices[k]] != no_cavity) return claims[vertices[k]];
  }
  return no_cavity;
}

}  // namespace aeroloom::cavities
