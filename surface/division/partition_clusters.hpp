/// Partitions clusters of background triangles into parts of equal load.
#pragma once

#include "surface/division/background_surface.hpp"
#include "surface/division/simplify_dual_graph.hpp"

#include <vector>

namespace aeroloom::partition {

/// The part of each triangle, by METIS on the simplified dual graph. The weight of an arc is the number of
/// fine edges that a cut there would have. Parts may be empty or have several components: repair_parts()
/// follows. The result depends on the arguments alone. Throws std::runtime_error when METIS fails.
std::vector<PartIndex> partition_clusters(const BackgroundSurface& surface, const Clusters& clusters,
                                          PartIndex parts);

}  // namespace aeroloom::partition
