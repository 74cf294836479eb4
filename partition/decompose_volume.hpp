/// From background tetrahedra to the pieces of a volume mesh.
///
/// A node of the dual graph is a background tetrahedron, an arc a face between two. Contracting an arc
/// forbids a cut there. Arcs are contracted until no two permitted cuts, and no permitted cut and the
/// boundary, meet at an angle below the threshold (after Chen, Zhao, Zheng et al., 22nd International Meshing
/// Roundtable, 2013, doi:10.1007/978-3-319-02335-9_31, there for surfaces). METIS partitions the contracted
/// graph; what it leaves is repaired by moving clusters from part to part.
#pragma once

#include "partition/background_volume.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::partition {

struct VolumeDecompositionOptions {
  std::int32_t parts = 1;  ///< wanted
  /// Degrees that interfaces make with each other and with the boundary at least, where the background allows
  /// it. 0: plain METIS on the dual graph, to compare with; its parts are connected and manifold all the
  /// same.
  double smallest_angle = 45;
};

struct VolumeDecomposition {
  std::vector<std::int32_t> part;  ///< per tetrahedron, numbered by first tetrahedron
  std::int32_t parts = 1;
  std::int32_t clusters = 0;    ///< nodes of the contracted graph
  double largest_cluster = 0;   ///< load, in wanted loads of a part
  std::int32_t unresolved = 0;  ///< wedges the contraction left because clusters would grow too heavy
  std::int32_t moves = 0;       ///< of clusters, by the repair
  std::int32_t pinches = 0;     ///< edges and vertices where a part still touches itself
};

/// A function of its arguments alone. Parts are connected by faces.
VolumeDecomposition decompose_volume(const BackgroundVolume& volume,
                                     const VolumeDecompositionOptions& options);

}  // namespace aeroloom::partition
