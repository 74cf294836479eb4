/// Interfaces vanish: the layer around them is refilled with their vertices gone and the global lattice
/// continued through it.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/size_field.hpp"
#include "volume/volume_mesher.hpp"

#include <cstdint>

namespace aeroloom::pipeline {

struct ErasureReport {
  int rounds = 0;
  std::int64_t cavities = 0, refilled = 0;
  std::int64_t vertices_before = 0, vertices_left = 0;  ///< of interfaces
  /// Mean ratio on average, of tetrahedra off the surface: with a vertex the refilling placed, and the
  /// others.
  double mean_ratio_refilled = 0, mean_ratio_elsewhere = 0;
};

/// Erases the vertices whose tokens are those of interfaces: from `first_token` on, as mesh_interfaces
/// numbers them. In the first round there is a cavity between every two pieces; what is left where three or
/// more meet is grouped by the cells of a grid as wide as the local size asks for, shifted from round to
/// round, so that what lies between two cells in one round is inside of one in the next. A last round refills
/// places where the lattice lacks a point because cavities met there. What cannot be refilled stays and is
/// counted. Collective. Throws CollectiveError.
ErasureReport erase_interfaces(const parallel::Communicator& communicator, mesh::DistributedMesh& mesh,
                               mesh::SharedToken first_token, const sizing::SizeField& field,
                               const volume::VolumeOptions& options, parallel::StageClock& clock);

}  // namespace aeroloom::pipeline
