/// Load balancing of the improvement stage.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <vector>

namespace aeroloom::improve {

/// Distributes the pieces over the ranks by expected work, heaviest first. `work` has one entry per local
/// piece. Pieces stay if no rank has more than 1.05 times the mean, or nothing would be gained. The mesh does
/// not depend on where its pieces are. Collective.
void balance_pieces(mesh::DistributedMesh& mesh, const std::vector<double>& work);

}  // namespace aeroloom::improve
