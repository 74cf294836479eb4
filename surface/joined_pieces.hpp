/// Pieces of faces that are remeshed together.
#pragma once

#include "surface/mesh_motion.hpp"

namespace aeroloom::surface {

/// Pieces of the faces that follow come last. Those of them that have moved (by piece of this rank) become
/// one a face where they are not too many triangles for a rank: else their common border, which stays, would
/// be in the way. Vertices keep their keys. Returns the pieces that have moved, ascending, the same on every
/// rank. Collective.
std::vector<mesh::PieceId> join_moved_pieces(const FollowingFaces& faces,
                                             const std::vector<std::uint8_t>& has_moved,
                                             mesh::DistributedMesh& surface);

}  // namespace aeroloom::surface
