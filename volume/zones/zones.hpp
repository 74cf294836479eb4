/// Zones: the sets of blocks that tetrahedra are scheduled by.
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

/// Which zone each leaf of the lattice belongs to: that of its block, unless it was reassigned. The
/// same on every rank that a block is local to.
class Zones {
public:
  /// Refers to `tree`. `cut_ghosts`: see fetch_cut_ghosts (halo.hpp).
  Zones(const LatticeTree& tree, ZoneCuts cuts, std::vector<GridCube> cut_ghosts = {});

  ZoneIndex count() const { return _cuts.count(); }
  ZoneIndex of(BlockIndex b, int child) const { return _reassigned.empty() ? _of_block[b] : find(b, child); }
  ZoneIndex of(const Leaf& leaf) const { return of(leaf.block, leaf.child); }
  /// Whether all leaves of a block are in one zone.
  bool is_whole(BlockIndex b) const;
  /// Whether a zone has leaves of a block.
  bool has(ZoneIndex zone, BlockIndex b) const;
  /// Reassigns a leaf. Ranks to which its block is not local are told as well.
  void reassign(const ReassignedLeaf& leaf);
  /// All that is of zone `from` becomes of zone `to`.
  void merge(ZoneIndex from, ZoneIndex to);

  /// Whether a cube that a border of zones cuts is a block, as far as it is local or a cut ghost.
  bool is_block(const GridCube& cube) const;
  /// Where blocks were cut, and what became of those zones: merged ones have another name.
  const ZoneCuts& cuts() const { return _cuts; }
  ZoneIndex name(ZoneIndex cut) const { return _names[cut]; }
  std::span<const ReassignedLeaf> reassigned() const { return _reassigned; }

  /// Sums over all ranks. `mine` has an entry per zone; those that are not 0 travel. Collective.
  std::vector<std::int64_t> sum(std::vector<std::int64_t> mine) const;

private:
  ZoneIndex find(BlockIndex b, int child) const;

  const LatticeTree& _tree;
  ZoneCuts _cuts;
  std::vector<GridCube> _cut_ghosts;        // along the curve
  std::vector<ZoneIndex> _names;            // of zones as they were cut
  std::vector<ZoneIndex> _of_block;         // without what was reassigned
  std::vector<ReassignedLeaf> _reassigned;  // by leaf
};

/// How many zones of about `piece_tets` tetrahedra: a volume of less than one and a half is one zone, and
/// others are rounded to three leading binary digits, so that zones of equal load divide well among ranks.
ZoneIndex wanted_zones(double expected_tetrahedra, std::int64_t piece_tets);

}  // namespace aeroloom::volume
