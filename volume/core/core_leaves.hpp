/// Which leaves of the lattice are *core*. Their tetrahedra come from a table. TetGen fills the *shell*
/// between them and the surface.
///
/// A leaf can be core if all its lattice points exist, lie in one region and keep core_clearance from the
/// surface. Two rules then demote leaves to the shell until nothing changes. The order does not matter. Both
/// look at squares between a core leaf and a shell leaf of the same size:
/// 1. The square has points on all four edges. They lie on one circle.
/// 2. The square is plain, without points on its edges. The shell has a point in the middle of the opposite
///    square, or of one of the leaf's four edges at right angles to the square.
/// Then all border triangles are in the Delaunay mesh of the shell's points. For a square of edge s, the ball
/// through its corners with its centre s/4 to s/2 inside the core contains no shell point (compare Labelle
/// and Shewchuk, *Isosurface stuffing*, ACM Trans. Graph. 26, 2007, doi:10.1145/1276377.1276448). They are
/// looked up after filling all the same: if one is missing, its leaf is demoted.
#pragma once

#include "volume/lattice/block_points.hpp"
#include "volume/lattice/ghost_layer.hpp"
#include "volume/lattice/leaf_surroundings.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// The core leaves in this rank's blocks and their ghosts. The same on any number of ranks.
class CoreLeaves {
public:
  /// `points` are all points of this rank's blocks, `changes` has one per block index. Collective.
  CoreLeaves(const LatticeTree& tree, std::span<const BlockChange> changes, const BlockPoints& points);

  /// The core leaves of a block, as bits.
  std::uint8_t of(BlockIndex b) const { return _core[_ghosts.place(b)]; }
  bool is_core(const Leaf& leaf) const { return of(leaf.block) >> leaf.child & 1; }
  /// The blocks of this rank whose core leaves differ from those in `other`, of the same lattice.
  std::vector<BlockIndex> blocks_unlike(const CoreLeaves& other) const;
  const GhostLayer& ghosts() const { return _ghosts; }
  /// The region of the core leaves of a block of this rank.
  mesh::RegionId region(BlockIndex b) const { return _regions[_ghosts.place(b)]; }

  /// Whether an own block with core leaves may have shell leaves or touch some.
  bool is_beside_shell(BlockIndex own) const { return _beside_shell[_ghosts.place(own)] != 0; }
  /// The sides of a shell leaf whose pyramid to its centre belongs to the core, as bits: those with a plain
  /// square to a core leaf of its size. The empty ball of such a square passes through that centre.
  static constexpr unsigned all_sides = 63;
  unsigned claims(const Leaf& leaf) const {
    return static_cast<unsigned>(_claims[_ghosts.place(leaf.block)] >> 6 * leaf.child & all_sides);
  }
  /// Whether a lattice point belongs to the shell. It does if it touches a shell leaf, in a part of it that
  /// the core does not claim.
  bool is_of_shell(const LeafSurroundings& around, const HalfPlace& at) const {
    return around.any_leaf_at(at, [&](const Leaf& leaf) { return has_shell_at(leaf, around, at); });
  }

private:
  bool has_shell_at(const Leaf& leaf, const LeafSurroundings& around, const HalfPlace& at) const;
  void choose(const LatticeTree& tree, std::span<const BlockChange> changes, const BlockPoints& points);
  bool has_all_around(const LeafSurroundings& around, mesh::RegionId region) const;
  bool is_beside_shell(const LeafSurroundings& around) const;
  void demote_until_stable(const LatticeTree& tree);
  void claim(const LatticeTree& tree);
  bool is_demoted(const LeafSurroundings& around, const HalfPlace& leaf) const;

  GhostLayer _ghosts;
  std::vector<std::uint8_t> _core;          // by place
  std::vector<std::uint64_t> _claims;       // by place: six bits per leaf, one per side
  std::vector<std::uint8_t> _beside_shell;  // of this rank's blocks
  std::vector<mesh::RegionId> _regions;     // of this rank's blocks
  /// Which points of a block exist, and their region.
  struct Present {
    std::uint64_t slots = 0;                  ///< as bits
    mesh::RegionId region = mesh::no_region;  ///< no_region if they lie in several
  };
  std::vector<Present> _present;  // by place, in the constructor alone
};

}  // namespace aeroloom::volume
