/// Repairs a partition by METIS: makes its parts connected and their borders meet at good angles.
#pragma once

#include "surface/division/background_surface.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

/// Keeps the heaviest component of each part. Each other one joins the neighbour with the longest common
/// border.
void connect_parts(const BackgroundSurface& surface, std::vector<PartIndex>& part);

/// Moves the triangles of wedges below `smallest_angle` (degrees) to the part on either side. A move is made
/// if it lowers the sum of missing degrees around these triangles. Parts may be disconnected afterwards:
/// connect_parts() follows. Deterministic. Returns the number of moves.
std::int32_t widen_wedges(const BackgroundSurface& surface, const VertexFans& fans, double smallest_angle,
                          std::vector<PartIndex>& part);

struct RepairOptions {
  double smallest_angle = 40;  ///< degrees between borders, and between borders and feature curves, as far as
                               ///< the surface allows; 0: no wedge is widened
  bool connects_parts = true;  ///< false: parts may stay disconnected, for comparison
};

/// Connects parts and widens wedges in turn, for a few rounds or until nothing changes. Then numbers the
/// parts by their first triangles, without empty ones. Returns their number.
PartIndex repair_parts(const BackgroundSurface& surface, const VertexFans& fans, const RepairOptions& options,
                       std::vector<PartIndex>& part);

}  // namespace aeroloom::partition
