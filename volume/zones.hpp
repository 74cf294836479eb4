/// Zones: the sets of blocks that tetrahedra are dealt out by.
#pragma once

#include "volume/block_points.hpp"
#include "volume/lattice_tree.hpp"
#include "volume/surface_share.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

using ZoneIndex = std::int32_t;
inline constexpr ZoneIndex no_zone = -1;

/// Tetrahedra of the shell around a lattice point, and next to the surface, per triangle. For each triangle
/// of the core's border there are fewer: half a point stands there, half of whose tetrahedra are the core's.
inline constexpr double tetrahedra_per_point = 5.75, tetrahedra_per_triangle = 2,
                        fewer_per_border = 0.5 * tetrahedra_per_point - 2;

/// Which zone each leaf of the lattice belongs to: that of its block, unless the leaf was given away. The
/// same on every rank.
class Zones {
public:
  Zones(std::vector<ZoneIndex> zone_of_block, ZoneIndex count)
      : _of_block(std::move(zone_of_block)), _count(count) {}

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
    LeafNumber leaf;
    ZoneIndex zone;
  };
  ZoneIndex find(BlockIndex b, int child) const;

  std::vector<ZoneIndex> _of_block;
  std::vector<Given> _given;  // by leaf
  ZoneIndex _count;
};

/// Expected tetrahedra of the shell in each block, from its points, triangles and border.
std::vector<double> block_loads(const SurfaceTable& table, std::span<const std::uint8_t> points,
                                std::span<const std::uint8_t> borders);

/// How many zones of about `piece_tets` tetrahedra: a volume of less than one and a half is one zone, and
/// others are rounded to three leading binary digits, so that zones of equal load divide well among ranks.
ZoneIndex wanted_zones(double expected_tetrahedra, std::int64_t piece_tets);

/// Zones of equal load by recursive bisection: always across the axis where the two halves have least in
/// common, in expected tetrahedra of the blocks beside the cut. Blocks without load go with their neighbours
/// along the curve. A function of its arguments.
Zones bisect(const LatticeTree& tree, std::span<const double> loads, ZoneIndex count);

}  // namespace aeroloom::volume
