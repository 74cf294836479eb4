/// Which leaves of the lattice are *core*: their tetrahedra come from a table, and TetGen fills the *shell*
/// between them and the surface.
///
/// A leaf may be core where all points of the lattice on it exist, in one region, `core_clearance` off the
/// surface. Of those a leaf leaves the core that has a plain square, without points on its edges, to a leaf
/// of its own size in the shell, while a point of the shell stands in the middle of one of the four edges
/// across that square, or of the square opposite. So does one with points on all four edges of such a square:
/// they lie on one circle. This until nothing changes, which ends in one result whatever the order. Then
/// every triangle of the core's *border* is in the Delaunay mesh of the shell's points without being asked
/// for: of a square of edge s the ball through its corners whose centre lies between s/4 and s/2 inside the
/// core holds no point of the shell (compare Labelle and Shewchuk, *Isosurface stuffing*, ACM Trans. Graph.
/// 26, 2007, doi:10.1145/1276377.1276448). It is looked up all the same, and a leaf with a triangle that is
/// missing leaves the core.
#pragma once

#include "volume/lattice/block_points.hpp"
#include "volume/lattice/ghost_blocks.hpp"
#include "volume/lattice/leaf_surroundings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// Of this rank's blocks and of those that touch them. The same on any number of ranks.
class CoreLeaves {
public:
  /// `points` are all those of this rank's blocks, `changes` those of all blocks. Collective.
  CoreLeaves(const LatticeTree& tree, std::span<const BlockChange> changes, const BlockPoints& points);

  /// The core leaves of a block, a bit each.
  std::uint8_t of(BlockIndex b) const { return _core[_ghosts.place(b)]; }
  bool is_core(const Leaf& leaf) const { return of(leaf.block) >> leaf.child & 1; }
  /// This rank's blocks whose core is another than in `other`, of the same lattice.
  std::vector<BlockIndex> blocks_unlike(const CoreLeaves& other) const;
  const GhostBlocks& ghosts() const { return _ghosts; }
  /// The region of the core leaves of one of this rank's blocks.
  mesh::RegionId region(BlockIndex b) const { return _regions[_ghosts.place(b)]; }

  /// Whether leaves of the shell may be among those of an own block with core leaves and those that touch it.
  bool is_beside_shell(BlockIndex own) const { return _beside_shell[_ghosts.place(own)] != 0; }
  /// The sides of a leaf of the shell, a bit each, where the pyramid of its centre belongs to the core: plain
  /// squares to core leaves of its size. The ball that proves such a square goes through that centre.
  static constexpr unsigned all_sides = 63;
  unsigned claims(const Leaf& leaf) const {
    return static_cast<unsigned>(_claims[_ghosts.place(leaf.block)] >> 6 * leaf.child & all_sides);
  }
  /// Whether a point of the lattice belongs to the shell: one of the leaves that touch it does, with a part
  /// there that the core does not claim.
  bool is_of_shell(const LeafSurroundings& around, const HalfPlace& at) const {
    return around.any_leaf_at(at, [&](const Leaf& leaf) { return has_shell_at(leaf, around, at); });
  }

private:
  bool has_shell_at(const Leaf& leaf, const LeafSurroundings& around, const HalfPlace& at) const;
  void choose(const LatticeTree& tree, std::span<const BlockChange> changes, const BlockPoints& points);
  bool has_all_around(const LeafSurroundings& around, mesh::RegionId region) const;
  bool is_beside_shell(const LeafSurroundings& around) const;
  void shrink_until_stable(const LatticeTree& tree);
  void claim(const LatticeTree& tree);
  bool leaves_core(const LeafSurroundings& around, const HalfPlace& leaf) const;

  GhostBlocks _ghosts;
  std::vector<std::uint8_t> _core;          // by place
  std::vector<std::uint64_t> _claims;       // by place: six sides of each leaf, a bit each
  std::vector<std::uint8_t> _beside_shell;  // of this rank's blocks
  std::vector<mesh::RegionId> _regions;     // of this rank's blocks
  /// The points of a block that exist, and their region.
  struct Present {
    std::uint64_t slots = 0;                  ///< points, a bit each
    mesh::RegionId region = mesh::no_region;  ///< of all of them; none where they lie in several
    static constexpr auto fields() { return std::tuple(&Present::slots, &Present::region); }
  };
  std::vector<Present> _present;  // while leaves are chosen
};

}  // namespace aeroloom::volume
