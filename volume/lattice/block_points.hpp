/// The interior points of the mesh: a graded body-centred lattice, made block by block.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "volume/lattice/lattice.hpp"
#include "volume/lattice/local_surface.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// Changes of a block by retries.
struct BlockChange {
  std::uint8_t variant = 0;  ///< seed of the perturbations
  std::uint8_t farther = 0;  ///< steps by which the clearance of its points was increased
  std::uint8_t shell = 0;    ///< leaves that must not be core, as bits (core_leaves.hpp)
};

/// A leaf has eight *slots* for lattice points: its low corner, its centre, and the middles of the three
/// edges and three faces at the low corner. The middles have a point only where smaller leaves touch them.
inline constexpr int slots_per_leaf = 8, slots_per_block = 64;

/// The place of a slot in its leaf, in half leaf edges.
inline constexpr int slot_places[slots_per_leaf][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                                       {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
/// The slot at a place: along each axis, 0 at the low corner and 1 half an edge from it.
inline int slot_at(int x, int y, int z) {
  constexpr int slots[8] = {0, 1, 2, 4, 3, 5, 6, 7};
  return slots[x + 2 * y + 4 * z];
}

/// The number of a lattice point from its block and slot, the same on every rank. Its shared-vertex key is
/// this number plus the number of surface vertices.
inline std::int64_t lattice_number(const LatticeTree& tree, BlockIndex block, int slot) {
  return tree.number(block) * slots_per_block + slot;
}
/// The leaf of the lattice point with a number.
inline LeafNumber leaf_number_of_lattice(std::int64_t number) {
  return number / slots_per_leaf;
}
inline Leaf leaf_of_lattice(const LatticeTree& tree, std::int64_t number) {
  return tree.leaf_of(leaf_number_of_lattice(number));
}

/// The points of consecutive blocks. Point i of block b has the index starts[b - first] + i; i ascends by
/// slot.
struct BlockPoints {
  BlockIndex first = 0;
  std::vector<std::int64_t> starts;  ///< blocks + 1
  std::vector<std::uint8_t> slots;
  std::vector<geometry::Vec3> points;
  std::vector<mesh::RegionId> regions;
  /// Per block: leaves whose corners and centre are at least core_clearance leaf edges from the surface, as
  /// bits.
  std::vector<std::uint8_t> clear_leaves;

  BlockIndex last() const { return first + static_cast<BlockIndex>(starts.size()) - 1; }
  std::int64_t count(BlockIndex b) const { return starts[b - first + 1] - starts[b - first]; }
};

/// The place of a slot's point, perturbed by a hash of the unperturbed place. `changes` has one per block
/// index, here and below.
geometry::Vec3 lattice_point(const Lattice& lattice, std::span<const BlockChange> changes, const Leaf& leaf,
                             int slot);
/// The same for the number of a lattice point.
inline geometry::Vec3 lattice_point(const Lattice& lattice, std::span<const BlockChange> changes,
                                    std::int64_t number) {
  return lattice_point(lattice, changes, leaf_of_lattice(lattice.tree, number),
                       static_cast<int>(number % slots_per_leaf));
}

/// The least distance from corners and centre of a core leaf to the surface, in leaf edges. Above 0.58 the
/// surface cannot enter the leaf. At 0.87 no surface vertex could lie in the ball that proves a border
/// triangle Delaunay (core_leaves.hpp). Below that, border triangles are looked up in the mesh of the shell.
inline constexpr double core_clearance = 0.6;

/// The coarsest level of blocks that count as far finer than a block of level `than`.
constexpr int far_finer_level(int than) {
  return than + 4;
}
/// The radii around a block within which it matters whether far finer blocks meet the surface, in the grid.
std::array<double, 2> finer_search_radii(const Lattice& lattice, BlockIndex b);

/// The search radii of blocks from `first` to before `last`, for the clearance and the regions of their
/// points. They are large enough for all retries.
SearchRadii search_radii_of_blocks(const Lattice& lattice, BlockIndex first, BlockIndex last);

/// Makes the points of blocks from `first` to before `last` that are inside a region and off the surface.
/// `surface` has all triangles within the radii. A point depends on its place, the sizes and the surface
/// nearby alone.
BlockPoints make_points(const Lattice& lattice, std::span<const BlockChange> changes, BlockIndex first,
                        BlockIndex last, const LocalSurface& surface, const SearchRadii& radii = {});

}  // namespace aeroloom::volume
