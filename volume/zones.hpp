/// Zones: the sets of blocks that tetrahedra are dealt out by.
#pragma once

#include "volume/lattice_tree.hpp"
#include "volume/zone_cuts.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// Which zone each leaf of the lattice belongs to: that of its block, unless the leaf was given away. The
/// same on every rank that knows a block.
class Zones {
public:
  Zones(std::vector<ZoneIndex> zone_of_block, ZoneIndex count)
      : _of_block(std::move(zone_of_block)), _count(count) {}
  Zones(const LatticeTree& tree, const ZoneCuts& cuts);

  ZoneIndex count() const { return _count; }
  ZoneIndex of(BlockIndex b, int child) const { return _given.empty() ? _of_block[b] : find(b, child); }
  /// Whether all leaves of a block are in one zone.
  bool is_whole(BlockIndex b) const;
  /// Whether a zone has leaves of a block, which has so many.
  bool has(ZoneIndex zone, BlockIndex b, int leaf_count) const {
    if (is_whole(b)) return of(b, 0) == zone;
    for (int child = 0; child < leaf_count; ++child) {
      if (of(b, child) == zone) return true;
    }
    return false;
  }
  /// Gives a leaf to another zone.
  void give(BlockIndex b, int child, ZoneIndex zone);
  /// All that is of zone `from` becomes of zone `to`.
  void merge(ZoneIndex from, ZoneIndex to);

private:
  struct Given {
    std::int64_t leaf;
    ZoneIndex zone;
  };
  static std::int64_t place_of(BlockIndex b, int child) { return 8 * std::int64_t{b} + child; }
  ZoneIndex find(BlockIndex b, int child) const;

  std::vector<ZoneIndex> _of_block;
  std::vector<Given> _given;  // by leaf
  ZoneIndex _count;
};

/// Sums over all ranks. `mine` has an entry per zone; those that are not 0 travel. Collective.
std::vector<std::int64_t> sum_by_zone(const parallel::Communicator& communicator,
                                      std::vector<std::int64_t> mine);

/// How many zones of about `piece_tets` tetrahedra: a volume of less than one and a half is one zone, and
/// others are rounded to three leading binary digits, so that zones of equal load divide well among ranks.
ZoneIndex wanted_zones(double expected_tetrahedra, std::int64_t piece_tets);

}  // namespace aeroloom::volume
