#include "volume/halo.hpp"

#include <algorithm>

namespace aeroloom::volume {

double largest_size_around(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
                           BlockIndex b) {
  double size = 0;
  tree.for_each_block_in(GridBox::of(tree.cube(b)).dilated(0.5), [&](BlockIndex n) {
    size =
        std::max({size, mean_edge_of_cell * frame.edge(tree.leaf_level(n)), double{table.longest_edge[n]}});
  });
  return size;
}

bool NearZone::knows(const GridBox& box) const {
  return std::any_of(boxes.begin(), boxes.end(),
                     [&](const GridBox& place) { return place.gap_to(box) <= reach; });
}

ZonesAround::ZonesAround(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
                         const Zones& zones, std::span<const double> widths)
    : _frame(frame),
      _tree(tree),
      _table(table),
      _zones(zones),
      _widths(widths),
      _widest(*std::max_element(widths.begin(), widths.end())),
      _alike_to(tree.block_count()) {
  for (BlockIndex b = tree.block_count(); b-- > 0;) {
    const bool goes_on = b + 1 < tree.block_count() && tree.is_known(b) && tree.is_known(b + 1) &&
                         zones.is_whole(b) && zones.is_whole(b + 1) && zones.of(b, 0) == zones.of(b + 1, 0);
    _alike_to[b] = goes_on ? _alike_to[b + 1] : b + 1;
  }
}

void ZonesAround::move_to(BlockIndex b) {
  const GridBox block = GridBox::of(_tree.cube(b));
  const double size = largest_size_around(_frame, _tree, _table, b);
  const GridBox around = block.dilated(reach(_frame, _tree, _table, b, _widest));
  _places.clear();
  _tree.any_block_in(
      around,
      [&](BlockIndex n) {
        if (_zones.is_whole(n)) {
          _places.push_back({_zones.of(n, 0), GridBox::of(_tree.cube(n))});
        } else {
          for (int child = 0; child < _tree.leaf_count(n); ++child)
            _places.push_back({_zones.of(n, child), GridBox::of(_tree.leaf(n, child))});
        }
        return false;
      },
      [&](BlockIndex first, BlockIndex last, const GridCube& cube) {
        if (last - first == 1 || !is_alike(first, last)) return false;
        const GridBox box = GridBox::of(cube);
        if (box.overlaps(around)) _places.push_back({_zones.of(first, 0), box});
        return true;
      });
  std::stable_sort(_places.begin(), _places.end(),
                   [](const Place& a, const Place& b) { return a.zone < b.zone; });
  _boxes.clear();
  _near.clear();
  for (const Place& place : _places) _boxes.push_back(place.box);
  for (std::size_t first = 0, last; first < _places.size(); first = last) {
    const ZoneIndex zone = _places[first].zone;
    for (last = first + 1; last < _places.size() && _places[last].zone == zone;) ++last;
    _near.push_back({zone, _frame.grid_distance(_widths[zone] * size),
                     std::span<const GridBox>(_boxes).subspan(first, last - first)});
  }
}

}  // namespace aeroloom::volume
