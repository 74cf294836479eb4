/// The surface mesh seen from the blocks of the lattice: a table of what meets each block, and each rank's
/// triangles near its own blocks.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/lattice/lattice_tree.hpp"
#include "volume/lattice/range_maximum.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// A triangle of the surface mesh with all that others need of it.
struct SurfaceTriangle {
  mesh::GlobalIndex number;                   ///< of the cell of the surface mesh
  std::array<mesh::GlobalIndex, 3> vertices;  ///< by number in the surface mesh
  std::array<geometry::Vec3, 3> points;
  std::array<std::int32_t, 3> entity;  ///< classification of the vertices
  std::array<mesh::CadDimension, 3> dimension;
  std::int32_t face, patch;
  mesh::RegionId front, back;  ///< regions on either side; counter-clockwise seen from outside the front one

  static constexpr auto fields() {
    return std::tuple(&SurfaceTriangle::number, &SurfaceTriangle::vertices, &SurfaceTriangle::points,
                      &SurfaceTriangle::entity, &SurfaceTriangle::dimension, &SurfaceTriangle::face,
                      &SurfaceTriangle::patch, &SurfaceTriangle::front, &SurfaceTriangle::back);
  }
};

/// A closed box in the grid around a triangle.
GridBox grid_box(const LatticeFrame& frame, const std::array<geometry::Vec3, 3>& points);

/// The triangles that meet each block, by block index; none for blocks that are not local.
struct SurfaceTable {
  std::vector<float> longest_edge;  ///< of the triangles that meet it; 0: none does
  // Of this rank's blocks, from the first on.
  std::vector<std::int32_t> triangles;  ///< those whose centre lies in it
  std::vector<float> nearest;           ///< how far one of them is from its centre, at most

  bool is_met(BlockIndex b) const { return longest_edge[b] > 0; }
  /// Whether one of the blocks from `first` to before `last` is that has at least this level.
  bool any_met(BlockIndex first, BlockIndex last, int least_level) const {
    return levels_met.over(first, last) > least_level;
  }
  /// Once all longest edges are known.
  void note_levels_met(const LatticeTree& tree);

  RangeMaximum levels_met;  ///< per block: one more than its level where it is met, else 0
};

/// The triangles that meet this rank's blocks, by number. Collective.
std::vector<SurfaceTriangle> deliver_surface(const LatticeFrame& frame, const LatticeTree& tree,
                                             const mesh::NumberedMesh& surface);

/// Of this rank's blocks, from the triangles that meet them.
SurfaceTable tabulate_surface(const LatticeFrame& frame, const LatticeTree& tree,
                              std::span<const SurfaceTriangle> triangles);

/// Distances from a block within which triangles matter to it, in the grid.
struct BlockSearchRadii {
  double least;  ///< every triangle that is nearer matters
  double most;  ///< none that is farther matters; in between those nearer than `per_edge` times their longest
                ///< edge
  double nearest = 0;  ///< one triangle is so near to all points of the block; 0: which one does not matter
  bool from_within = false;  ///< what meets the block tells the regions there (within_blocks.hpp)
};

struct SearchRadii {
  std::vector<BlockSearchRadii> of_blocks;  ///< of this rank
  double per_edge = 0;                      ///< grid distance per length

  /// Of a rank's block, by its place among the rank's own.
  bool is_from_within(std::size_t i) const { return i < of_blocks.size() && of_blocks[i].from_within; }
};

/// With those that other ranks have and that come within the search radii of this rank's blocks. By number,
/// each once. Collective.
std::vector<SurfaceTriangle> add_those_near(const LatticeFrame& frame, const LatticeTree& tree,
                                            const SearchRadii& radii, std::vector<SurfaceTriangle> own);

}  // namespace aeroloom::volume
