/// Repair of what simplification could not prevent: small angles between fine interfaces, or between them and
/// the surface, are opened by moving vertices of the interfaces.
#pragma once

#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "pipeline/interfaces.hpp"
#include "pipeline/piece_boundary.hpp"
#include "pipeline/volume_plan.hpp"

#include <cstdint>

namespace aeroloom::pipeline {

/// Turns triangles of interfaces around edges where they make less than `wanted` degrees, for a few rounds.
/// Returns the number of vertices moved, over all rounds. Collective.
std::int64_t widen_interfaces(const parallel::Communicator& communicator,
                              const mesh::DistributedMesh& surface, const mesh::Numbering& numbering,
                              const VolumePlan& plan, double wanted, InterfaceMesh& interfaces,
                              parallel::StageClock& clock);

}  // namespace aeroloom::pipeline
