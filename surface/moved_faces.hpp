/// Remeshes curved faces whose boundaries have moved: ends of boundary layers that are no planes.
#pragma once

#include "surface/mesh_motion.hpp"
#include "surface/plane_remesher.hpp"

namespace aeroloom::surface {

/// Moves the mesh of faces after their boundaries, within the CAD surface, and remeshes it there. Vertices on
/// curves between them, and between them and faces that are made again, stay on their curves. Each piece
/// keeps its border; pieces are those of `before`, where nothing had moved.
///
/// Pieces of other faces stay the same, keep their order and come first; those of these faces follow in
/// their order. Where a boundary would turn triangles over, the vertices of the boundary that they follow are
/// returned; these must move less. The surface is then of no use.
///
/// Collective; the same on any number of ranks.
PlaneConflicts remesh_moved_faces(const cad::Model& model, const sizing::SizeField& field,
                                  const FollowingFaces& faces, const SurfaceOptions& options,
                                  const mesh::DistributedMesh& before, mesh::DistributedMesh& surface);

}  // namespace aeroloom::surface
