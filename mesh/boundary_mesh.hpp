/// The boundary of a tetrahedral mesh as a surface mesh of its own.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"

namespace aeroloom::mesh {

/// The boundary triangles, those between two regions included: one piece per tetrahedral piece and CAD face
/// in it, in the order of the pieces and faces, on the rank of the tetrahedral piece. Vertices keep their
/// coordinates and classification; those that several pieces may know are named by their number in the
/// tetrahedral mesh. Collective.
DistributedMesh boundary_mesh(const parallel::Communicator& communicator, const DistributedMesh& volume,
                              const Numbering& numbering);

}  // namespace aeroloom::mesh
