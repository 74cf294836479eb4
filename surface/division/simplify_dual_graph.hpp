/// Simplification of the dual graph of a background surface before it is partitioned.
///
/// A node of the dual graph is a background triangle, an arc an edge between two. Contracting an arc forbids
/// a cut along that edge. Arcs are contracted until no two permitted cuts, and no permitted cut and feature
/// curve, meet at an angle below the threshold (after Chen, Zhao, Zheng et al., 22nd International Meshing
/// Roundtable, 2013, doi:10.1007/978-3-319-02335-9_31). docs/decomposition.md draws the operations.
#pragma once

#include "surface/division/background_surface.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

struct SimplifyOptions {
  double smallest_angle = 40;  ///< degrees that permitted cuts make with each other and with feature curves;
                               ///< 0: nothing is contracted, to compare with
  double largest_load = 0;  ///< a cluster does not grow beyond this load; what that leaves is repaired later;
                            ///< 0: no limit
};

/// The contracted dual graph: clusters of triangles.
struct Clusters {
  std::vector<ClusterIndex> of_triangle;  ///< cluster per triangle, numbered by first triangle
  std::vector<double> loads;              ///< per cluster
  std::int32_t forbidden_edges = 0;       ///< inner edges where no cut is permitted
  std::int32_t unresolved = 0;            ///< wedges left open because their clusters would grow too heavy
};

/// Contracts arcs, the sharpest wedges first. Of the two edges of a wedge that one is contracted whose
/// clusters are lighter together; ties go to the lower half-edge. Deterministic.
Clusters simplify_dual_graph(const BackgroundSurface& surface, const VertexFans& fans,
                             const SimplifyOptions& options);

}  // namespace aeroloom::partition
