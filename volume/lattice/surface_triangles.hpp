/// The triangles of the surface mesh near the blocks of the lattice, on the ranks that own these blocks.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "volume/lattice/lattice_tree.hpp"
#include "volume/lattice/range_maximum.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// A triangle of the surface mesh with its CAD classification, as it is sent to other ranks.
struct SurfaceTriangle {
  mesh::GlobalIndex number;                   ///< of the cell of the surface mesh
  std::array<mesh::GlobalIndex, 3> vertices;  ///< by number in the surface mesh
  std::array<geometry::Vec3, 3> points;
  std::array<std::int32_t, 3> entity;  ///< classification of the vertices
  std::array<mesh::CadDimension, 3> dimension;
  std::int32_t face, patch;
  /// The regions on either side: the normal points from `inside` to `outside`.
  mesh::RegionId inside, outside;
};

/// The bounding box of a triangle in the grid, enlarged by more than rounding.
GridBox grid_box(const LatticeFrame& frame, const std::array<geometry::Vec3, 3>& points);

/// The triangles that meet each block. The first array is by block index, the others by own block.
struct SurfaceTable {
  std::vector<float> longest_edge;  ///< of the triangles that meet the block; 0: none, or not a local block
  std::vector<std::int32_t> triangles;  ///< number of triangles with their centre in the block
  std::vector<float> nearest;  ///< distance from the block's centre to the nearest triangle, rounded up

  bool is_met(BlockIndex b) const { return longest_edge[b] > 0; }
  /// Whether a triangle meets a block of at least this level, from `first` to before `last`.
  bool any_met(BlockIndex first, BlockIndex last, int least_level) const {
    return levels_met.over(first, last) > least_level;
  }
  /// Fills `levels_met` from `longest_edge`.
  void note_levels_met(const LatticeTree& tree);

  RangeMaximum levels_met;  ///< per block: its level plus one if a triangle meets it, else 0
};

/// Sends each triangle to the ranks whose blocks it meets. Returns those of this rank, by number. Collective.
std::vector<SurfaceTriangle> deliver_surface(const LatticeFrame& frame, const LatticeTree& tree,
                                             const mesh::NumberedMesh& surface);

/// The table of this rank's blocks. `triangles` are all that meet them.
SurfaceTable tabulate_surface(const LatticeFrame& frame, const LatticeTree& tree,
                              std::span<const SurfaceTriangle> triangles);

/// Distances from a block within which triangles matter to its points, in the grid.
struct BlockSearchRadii {
  double least;  ///< all nearer triangles matter
  double most;   ///< no farther triangle matters; in between: nearer than `per_edge` times its longest edge
  double nearest = 0;              ///< the nearest triangle of each point is within it; 0: it is not needed
  bool region_from_block = false;  ///< regions of its points are found by RegionInBlock
};

/// The search radii of this rank's blocks.
struct SearchRadii {
  std::vector<BlockSearchRadii> of_blocks;  ///< from the first own block on
  double per_edge = 0;                      ///< grid distance per edge length in space

  /// `i` counts own blocks from 0.
  bool is_region_from_block(std::size_t i) const {
    return i < of_blocks.size() && of_blocks[i].region_from_block;
  }
};

/// Adds the triangles of other ranks that are within the search radii of this rank's blocks. Returns all by
/// number, each once. Collective.
std::vector<SurfaceTriangle> add_ghost_triangles(const LatticeFrame& frame, const LatticeTree& tree,
                                                 const SearchRadii& radii, std::vector<SurfaceTriangle> own);

}  // namespace aeroloom::volume
