#include "volume/met_blocks.hpp"

#include "volume/boundary_distance.hpp"

#include <cmath>
#include <limits>

namespace aeroloom::volume {

using geometry::Vec3;

MetBlocks::MetBlocks(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table)
    : _table(table) {
  constexpr int leaf_size = 4;
  for (BlockIndex b = 0; b < tree.block_count(); ++b) {
    if (!table.is_met(b)) continue;
    const GridBox box = GridBox::of(tree.cube(b));
    geometry::Box& around = _boxes.emplace_back();
    for (int corner = 0; corner < 8; ++corner)
      around.add(frame.to_space({corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                                 corner & 4 ? box.high.z : box.low.z}));
    _blocks.push_back(b);
  }
  _tree = geometry::BoxTree(_boxes, leaf_size);
}

double MetBlocks::away(Vec3 p, const geometry::Box& box) {
  return std::sqrt(BoundaryDistance::squared_distance(p, box));
}

double MetBlocks::distance_at_most(Vec3 p) const {
  double least = std::numeric_limits<double>::infinity();
  _tree.search_nearest([&](const geometry::Box& box) { return away(p, box); }, least,
                       [&](std::int32_t place) {
                         const std::int32_t i = _tree.order()[place];
                         least =
                             std::min(least, distance(p, _boxes[i].center()) + _table.nearest[_blocks[i]]);
                       });
  return least;
}

}  // namespace aeroloom::volume
