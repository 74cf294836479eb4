/// The boundary of a tetrahedral mesh as a surface mesh of its own.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"

#include <cstdint>

namespace aeroloom::mesh {

/// The boundary triangles, those between two regions included: one piece per tetrahedral piece and CAD face
/// in it, in the order of the pieces and faces, on the rank of the tetrahedral piece. Vertices keep their
/// coordinates and classification; those that several pieces may know are named by their number in the
/// tetrahedral mesh. Collective.
DistributedMesh boundary_mesh(const NumberedMesh& volume);

/// What a surface mesh has of triangles: those that one region lies behind, or those that two share.
enum class SurfacePart : std::uint8_t { outside, between_regions };
/// The chosen triangles alone. Pieces keep their ids, left out ones are empty. Not collective.
DistributedMesh part_of_surface(const DistributedMesh& surface, SurfacePart which);

/// Triangles of a tetrahedral piece by CAD face, in their order: that of boundary_mesh.
std::vector<LocalIndex> triangles_by_face(const Piece& piece);

}  // namespace aeroloom::mesh
