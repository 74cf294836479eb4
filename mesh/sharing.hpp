/// Which vertices pieces really share.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"

#include <cstdint>

namespace aeroloom::mesh {

/// Strikes vertices off the lists of shared ones that no other piece knows any more. Refilled cavities
/// (cavities/rounds.hpp) leave many of them. Numbering and hash stay as they are. Returns their number in the
/// whole mesh. Collective.
std::int64_t forget_unshared(const parallel::Communicator& communicator, DistributedMesh& mesh);

}  // namespace aeroloom::mesh
