/// Which region the blocks lie in that the surface does not meet.
#pragma once

#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "volume/lattice_tree.hpp"
#include "volume/near_surface.hpp"
#include "volume/surface_share.hpp"

#include <span>
#include <vector>

namespace aeroloom::volume {

/// Per block: its region, mesh::no_region outside of all, and also where the surface meets it (there each
/// point is asked for itself). Blocks that share a face are of one region; for each such set one place where
/// it touches a block that the surface meets is looked at, by the rank that has that block. The same on every
/// rank. Collective. Throws CollectiveError when the surface has a gap.
std::vector<mesh::RegionId> find_block_regions(const parallel::Communicator& communicator,
                                               const LatticeFrame& frame, const LatticeTree& tree,
                                               const SurfaceTable& table, std::span<const BlockIndex> shares,
                                               const NearSurface& surface, parallel::StageClock& clock);

}  // namespace aeroloom::volume
