/// The interior points: a graded body-centred lattice, block by block.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "volume/lattice/lattice.hpp"
#include "volume/lattice/near_surface.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// Changes that retries have made to a block.
struct BlockChange {
  std::uint8_t variant = 0;  ///< another number gives other perturbations
  std::uint8_t farther = 0;  ///< steps by which its points keep farther off the surface
  std::uint8_t shell = 0;    ///< leaves that may not be core, a bit each (core_leaves.hpp)
};

/// A lattice point stands at the low corner of a leaf, in the middle of one of three edges or faces there
/// (where smaller leaves touch it), or in its centre: eight *slots* of each of the eight leaves of a block.
inline constexpr int slots_per_leaf = 8, slots_per_block = 64;

/// A slot's place in its leaf, in halves of the leaf's edge.
inline constexpr int slot_places[slots_per_leaf][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                                                       {1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
/// The slot of a place at the low corner of a leaf (0) or half an edge from it (1) along each axis.
inline int slot_at(int x, int y, int z) {
  constexpr int slots[8] = {0, 1, 2, 4, 3, 5, 6, 7};
  return slots[x + 2 * y + 4 * z];
}

/// Which block and slot a point of the lattice has, by a running number: its shared-vertex key after those
/// of the surface.
inline std::int64_t lattice_number(const LatticeTree& tree, BlockIndex block, int slot) {
  return tree.number(block) * slots_per_block + slot;
}
/// The leaf that such a point belongs to.
inline LeafNumber leaf_number_of_lattice(std::int64_t number) {
  return number / slots_per_leaf;
}
inline Leaf leaf_of_lattice(const LatticeTree& tree, std::int64_t number) {
  return tree.leaf_of(leaf_number_of_lattice(number));
}

/// The points of consecutive blocks. Point i of block b: [starts[b - first] + i], by slot.
struct BlockPoints {
  BlockIndex first = 0;
  std::vector<std::int64_t> starts;  ///< blocks + 1
  std::vector<std::uint8_t> slots;
  std::vector<geometry::Vec3> points;
  std::vector<mesh::RegionId> regions;
  /// Per block: the leaves whose corners and centre keep `core_clearance` leaf edges off the surface.
  std::vector<std::uint8_t> clear_leaves;

  BlockIndex last() const { return first + static_cast<BlockIndex>(starts.size()) - 1; }
  std::int64_t count(BlockIndex b) const { return starts[b - first + 1] - starts[b - first]; }
};

/// Where the point of a slot stands if there is one: perturbed by a hash of its place. `changes` are those of
/// all blocks, here and below.
geometry::Vec3 lattice_point(const Lattice& lattice, std::span<const BlockChange> changes, const Leaf& leaf,
                             int slot);
/// The same, by running number.
inline geometry::Vec3 lattice_point(const Lattice& lattice, std::span<const BlockChange> changes,
                                    std::int64_t number) {
  return lattice_point(lattice, changes, leaf_of_lattice(lattice.tree, number),
                       static_cast<int>(number % slots_per_leaf));
}

/// How far the corners and the centre of a leaf of the core keep off the surface, in leaf edges. Above 0.58
/// nothing between them can enter the leaf; at 0.87 no point of the surface stands in a ball through the
/// corners of a square whose emptiness proves it (core_leaves.hpp). In between the mesh of the shell is
/// asked.
inline constexpr double core_clearance = 0.6;

/// The level from which on blocks are so much finer than one of `than` that they are looked at together.
constexpr int far_finer_level(int than) {
  return than + 4;
}
/// How far from a block far finer ones on the surface are looked for, in the grid.
std::array<double, 2> looks_of_block(const Lattice& lattice, BlockIndex b);

/// How far triangles matter to blocks `first` to `last`: for the clearance of their points, and for telling
/// the region of points there. Retries included.
SearchRadii search_radii_of_blocks(const Lattice& lattice, BlockIndex first, BlockIndex last);

/// The points of blocks `first` to `last`: corners and centres of leaves, inside a region and off the
/// surface. `surface` has the triangles within these radii. A function of place, sizes and the
/// surface nearby.
BlockPoints make_points(const Lattice& lattice, std::span<const BlockChange> changes, BlockIndex first,
                        BlockIndex last, const NearSurface& surface, const SearchRadii& radii = {});

}  // namespace aeroloom::volume
