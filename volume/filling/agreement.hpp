/// Checks that the tetrahedra of zones fit together. Remedies: retry_policy.hpp.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "volume/filling/zone_piece.hpp"

#include <span>
#include <vector>

namespace aeroloom::volume {

/// The faces of all ranks without a partner: a face of another zone with the same vertices, the same region
/// and the opposite orientation. Sorted by vertices and zone, the same on every rank. Collective.
std::vector<ZoneFace> find_unmatched(const parallel::Communicator& communicator,
                                     std::span<const ZoneFace> faces);

/// A place where zones disagree: faces without partner, connected over vertices.
struct DisputedPlace {
  std::vector<LeafNumber> leaves;  ///< octree leaves of its vertices, ascending; TetGen's own have none
  std::vector<ZoneIndex> zones;    ///< with faces there, ascending
  std::int32_t faces = 0;
};
/// The places of faces from find_unmatched(), by lowest vertex.
std::vector<DisputedPlace> find_places(std::span<const ZoneFace> unmatched);

}  // namespace aeroloom::volume
