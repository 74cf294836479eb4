/// The interior points: a graded body-centred lattice, block by block.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/piece.hpp"
#include "sizing/size_field.hpp"
#include "volume/lattice_tree.hpp"
#include "volume/near_surface.hpp"
#include "volume/surface_share.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

struct LatticeOptions {
  double clearance = 0.5;       ///< distance from the surface, in local sizes
  double perturbation = 0.005;  ///< in mean edges of the lattice
};

/// What retries have changed of a block.
struct BlockChange {
  std::uint8_t variant = 0;  ///< another number gives other perturbations
  std::uint8_t farther = 0;  ///< steps by which its points keep farther off the surface
};

/// A lattice point stands at the low corner of a leaf, in the middle of one of three edges or faces there
/// (where smaller leaves touch it), or in its centre: eight *slots* of each of the eight leaves of a block.
inline constexpr int slots_per_leaf = 8, slots_per_block = 64;

/// Which block and slot a point of the lattice has, by a running number: its token behind those of the
/// surface.
inline std::int64_t lattice_number(BlockIndex block, int slot) {
  return std::int64_t{block} * slots_per_block + slot;
}

/// The points of consecutive blocks. Point i of block b: [starts[b - first] + i], by slot.
struct BlockPoints {
  BlockIndex first = 0;
  std::vector<std::int64_t> starts;  ///< blocks + 1
  std::vector<std::uint8_t> slots;
  std::vector<geometry::Vec3> points;
  std::vector<mesh::RegionId> regions;

  BlockIndex last() const { return first + static_cast<BlockIndex>(starts.size()) - 1; }
  std::int64_t count(BlockIndex b) const { return starts[b - first + 1] - starts[b - first]; }
};

/// What points are made from.
struct LatticeSource {
  const LatticeFrame& frame;
  const LatticeTree& tree;
  const sizing::SizeField& field;
  const SurfaceTable& table;
  std::span<const mesh::RegionId> regions;  ///< per block, see find_block_regions
  LatticeOptions options;
  std::span<const BlockChange> changes;  ///< per block
};

/// How regions are told in blocks far from a body, which are as large as it is far off and where one of its
/// many triangles may be the nearest.
enum class FarBlocks { by_nearest, from_within };

/// How far triangles matter to blocks `first` to `last`: for the clearance of their points, and for telling
/// the region of points there. Retries included.
SurfaceReach reach_of_blocks(const LatticeSource& source, BlockIndex first, BlockIndex last,
                             FarBlocks far = FarBlocks::from_within);

/// The points of blocks `first` to `last`: corners and centres of leaves, inside a region and off the
/// surface. `surface` has the triangles within this reach of these blocks. A function of place, sizes and the
/// surface nearby.
BlockPoints make_points(const LatticeSource& source, BlockIndex first, BlockIndex last,
                        const NearSurface& surface, const SurfaceReach& reach = {});

}  // namespace aeroloom::volume
