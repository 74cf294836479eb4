/// Zones: sets of leaves that are filled with tetrahedra by one task each.
#pragma once

#include "volume/lattice/lattice_tree.hpp"
#include "volume/zones/zone_cuts.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// A leaf that was reassigned to another zone.
struct ReassignedLeaf {
  BlockNumber block;
  int child;
  GridBox box;
  ZoneIndex zone;
};

/// The zone of each leaf: that of its block, unless the leaf was reassigned. The same on every rank where the
/// block is local.
class Zones {
public:
  /// Refers to `tree`. `cut_ghosts` come from fetch_cut_ghosts() (halo.hpp).
  Zones(const LatticeTree& tree, ZoneCuts cuts, std::vector<GridCube> cut_ghosts = {});

  ZoneIndex count() const { return _cuts.count(); }
  ZoneIndex of(BlockIndex b, int child) const { return _reassigned.empty() ? _of_block[b] : find(b, child); }
  ZoneIndex of(const Leaf& leaf) const { return of(leaf.block, leaf.child); }
  /// Whether no leaf of a block was reassigned.
  bool is_whole(BlockIndex b) const;
  /// Whether a zone has leaves of a block.
  bool has(ZoneIndex zone, BlockIndex b) const;
  /// Reassigns a leaf. To be called on every rank, also where the block is not local.
  void reassign(const ReassignedLeaf& leaf);
  /// Moves all leaves of zone `from` to zone `to`.
  void merge(ZoneIndex from, ZoneIndex to);

  /// Whether a cube that a plane between zones cuts is a block. The block must be local or a cut ghost.
  bool is_block(const GridCube& cube) const;
  /// The planes, with zones as they were before any was merged, and the present zone of each of these.
  const ZoneCuts& cuts() const { return _cuts; }
  ZoneIndex name(ZoneIndex cut) const { return _names[cut]; }
  std::span<const ReassignedLeaf> reassigned() const { return _reassigned; }

  /// Sums over all ranks. `mine` has one entry per zone; only nonzero ones are sent. Collective.
  std::vector<std::int64_t> sum(std::vector<std::int64_t> mine) const;

private:
  ZoneIndex find(BlockIndex b, int child) const;

  const LatticeTree& _tree;
  ZoneCuts _cuts;
  std::vector<GridCube> _cut_ghosts;        // in Morton order
  std::vector<ZoneIndex> _names;            // present zone of each zone of the cuts
  std::vector<ZoneIndex> _of_block;         // without reassigned leaves
  std::vector<ReassignedLeaf> _reassigned;  // by leaf
};

/// The number of zones of about `piece_tets` tetrahedra. Below 1.5 it is one; otherwise it is rounded to
/// three leading binary digits, so that zones of equal load divide well among ranks.
ZoneIndex wanted_zones(double expected_tetrahedra, std::int64_t piece_tets);

}  // namespace aeroloom::volume
