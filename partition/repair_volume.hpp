/// What METIS leaves to be done on the parts of a background volume.
#pragma once

#include "partition/background_volume.hpp"
#include "partition/simplify_volume.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

struct VolumeRepair {
  std::int32_t moves = 0;    ///< of clusters
  std::int32_t pinches = 0;  ///< edges and vertices left where a part touches itself
};

/// Makes parts connected by faces, bounded by closed 2-manifolds, and their interfaces meet each other and
/// the boundary at no less than `smallest_angle` (degrees; 0: any), by moving whole clusters to neighbouring
/// parts. A cluster moves only a few times, so this ends; what is left is counted. Connection always holds.
/// Deterministic.
VolumeRepair repair_parts(const BackgroundVolume& volume, const EdgeRings& rings,
                          const VolumeClusters& clusters, double smallest_angle,
                          std::vector<std::int32_t>& part);

}  // namespace aeroloom::partition
