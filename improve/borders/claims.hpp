/// Claims: which vertex stars become part of which cavity in a round. Used by rounds.cpp.
#pragma once

#include "improve/borders/rounds.hpp"

namespace aeroloom::cavities {

/// Withdraws claims of vertices that have a neighbour claimed by another cavity in any piece. Collective.
void withdraw_contested_claims(const mesh::DistributedMesh& mesh, const mesh::SharedVertices& shared,
                               CavityClaims& claims);

/// Adds to each cavity its neighbouring interior vertices that are next to no other cavity. With
/// `along_surface` also vertices on the surface.
void widen(const mesh::Piece& piece, bool along_surface, std::vector<CavityId>& claims);

/// The first claim among some vertices, or no_cavity.
inline CavityId cavity_of(const std::vector<CavityId>& claims, const mesh::LocalIndex* vertices, int count) {
  for (int k = 0; k < count; ++k) {
    if (claims[vertices[k]] != no_cavity) return claims[vertices[k]];
  }
  return no_cavity;
}

}  // namespace aeroloom::cavities
