/// Which rank improves which piece.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <vector>

namespace aeroloom::improve {

/// Deals the pieces out anew by the work expected, `work` per local piece, heaviest first; they stay where
/// they are while no rank has more than 1.05 times the mean, or nothing would be gained. Which rank holds a
/// piece changes nothing in the mesh. Collective.
void balance_pieces(mesh::DistributedMesh& mesh, const std::vector<double>& work);

}  // namespace aeroloom::improve
