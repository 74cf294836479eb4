/// Repair of what METIS does not see to: that parts are connected, and that their borders meet at good
/// angles.
#pragma once

#include "surface/division/background_surface.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

/// Gives all but the heaviest component of each part to the neighbour it shares the longest border with.
void connect_parts(const BackgroundSurface& surface, std::vector<PartIndex>& part);

/// Moves the triangles of wedges below `smallest_angle` (degrees) to the part on either side when that makes
/// the sum of what is missing around them smaller. Parts may fall apart: connect_parts() follows.
/// Deterministic. Returns the number of moves.
std::int32_t widen_wedges(const BackgroundSurface& surface, const VertexFans& fans, double smallest_angle,
                          std::vector<PartIndex>& part);

struct RepairOptions {
  double smallest_angle = 40;  ///< degrees that borders make with each other and with feature curves, as far
                               ///< as the surface allows it; 0: no wedge is widened
  bool connects_parts = true;  ///< false: parts may stay asunder, to compare with
};

/// Joins stray components and widens wedges in turn, until nothing moves or a few rounds have passed. Parts
/// are numbered by their first triangles, none is empty. Returns their number.
PartIndex repair_parts(const BackgroundSurface& surface, const VertexFans& fans, const RepairOptions& options,
                       std::vector<PartIndex>& part);

}  // namespace aeroloom::partition
