/// Whether zones fit together, and where they do not; what is done about it is in retry_policy.hpp.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "volume/filling/zone_piece.hpp"

#include <span>
#include <vector>

namespace aeroloom::volume {

/// The faces that have no partner: another zone's face with the same vertices, with the other orientation, in
/// the same region. By vertices and zone, the same on every rank. Collective.
std::vector<ZoneFace> find_unmatched(const parallel::Communicator& communicator,
                                     std::span<const ZoneFace> faces);

/// A place where zones disagree: faces without partner that are connected by vertices.
struct DisputedPlace {
  std::vector<LeafNumber> leaves;  ///< of the vertices, ascending; none where TetGen added them all
  std::vector<ZoneIndex> zones;    ///< that claim faces there, ascending
  std::int32_t faces = 0;
};
/// By lowest vertex.
std::vector<DisputedPlace> find_places(std::span<const ZoneFace> unmatched);

}  // namespace aeroloom::volume
