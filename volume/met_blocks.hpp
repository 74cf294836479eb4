/// The blocks that the surface meets, searched from far away.
#pragma once

#include "geometry/box_tree.hpp"
#include "volume/lattice_tree.hpp"
#include "volume/surface_share.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace aeroloom::volume {

/// Bounds the distance of the surface by what is known of the blocks that it meets, and finds those that may
/// hold the triangle nearest to a point. Refers to the table. The same on every rank.
class MetBlocks {
public:
  MetBlocks(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table);

  /// Calls visit(block) for all blocks that meet a triangle which may be the nearest to a point less than
  /// `off` away from p, in space, or be crossed on the way to its inside (NearSurface::region_at).
  template <class Visit>
  void for_each_nearest(geometry::Vec3 p, double off, const Visit& visit) const {
    const double reach = distance_at_most(p) + 2 * off;
    double longest = 0;
    for_each_within(p, reach, [&](std::int32_t i) {
      longest = std::max<double>(longest, _table.longest_edge[_blocks[i]]);
    });
    constexpr double inward = 0.1;
    for_each_within(p, reach + inward * longest, [&](std::int32_t i) { visit(_blocks[i]); });
  }

private:
  template <class Visit>
  void for_each_within(geometry::Vec3 p, double reach, const Visit& visit) const {
    _tree.search([&](const geometry::Box& box) { return away(p, box) <= reach; },
                 [&](std::int32_t place) {
                   const std::int32_t i = _tree.order()[place];
                   if (away(p, _boxes[i]) <= reach) visit(i);
                 });
  }
  static double away(geometry::Vec3 p, const geometry::Box& box);
  /// How far p is from the surface.
  double distance_at_most(geometry::Vec3 p) const;

  const SurfaceTable& _table;
  std::vector<BlockIndex> _blocks;
  std::vector<geometry::Box> _boxes;  ///< in space, around each of them
  geometry::BoxTree _tree;
};

}  // namespace aeroloom::volume
