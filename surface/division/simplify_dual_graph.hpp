/// Simplifies the dual graph of a background surface before it is partitioned.
///
/// Nodes of the dual graph are background triangles, arcs are edges between two triangles. A contracted arc
/// forbids a cut along its edge. Arcs are contracted until no two permitted cuts meet below the threshold
/// angle, and no permitted cut meets a feature curve below it (after Chen, Zhao, Zheng et al., 22nd
/// International Meshing Roundtable, 2013, doi:10.1007/978-3-319-02335-9_31). docs/decomposition.md draws the
/// operations.
#pragma once

#include "surface/division/background_surface.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

struct SimplifyOptions {
  double smallest_angle = 40;  ///< degrees between permitted cuts, and between these and feature curves; 0:
                               ///< nothing is contracted, for comparison
  double largest_load = 0;  ///< largest load of a cluster; wedges that remain are repaired later; 0: no limit
};

/// The contracted dual graph: its nodes are clusters of triangles.
struct Clusters {
  std::vector<ClusterIndex> of_triangle;  ///< cluster per triangle, numbered by first triangle
  std::vector<double> loads;              ///< per cluster
  std::int32_t forbidden_edges = 0;       ///< inner edges where no cut is permitted
  std::int32_t unresolved = 0;            ///< wedges that remain because their clusters would be too heavy
};

/// Contracts arcs, sharpest wedges first. Of the two edges of a wedge it contracts the one whose two clusters
/// are lighter together. Ties go to the lower half-edge. Deterministic.
Clusters simplify_dual_graph(const BackgroundSurface& surface, const VertexFans& fans,
                             const SimplifyOptions& options);

}  // namespace aeroloom::partition
