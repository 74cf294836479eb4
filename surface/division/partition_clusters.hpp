/// From clusters of background triangles to parts of equal load.
#pragma once

#include "surface/division/background_surface.hpp"
#include "surface/division/simplify_dual_graph.hpp"

#include <vector>

namespace aeroloom::partition {

/// METIS on the simplified dual graph: the part of each triangle. An arc weighs as much as the fine edges a
/// cut there would have. Some of the `parts` may stay empty, and a part may fall asunder: repair_parts()
/// follows. A function of its arguments alone. Throws std::runtime_error when METIS fails.
std::vector<PartIndex> partition_clusters(const BackgroundSurface& surface, const Clusters& clusters,
                                          PartIndex parts);

}  // namespace aeroloom::partition
