#include "volume/halo.hpp"

#include <algorithm>
#include <numeric>

namespace aeroloom::volume {

namespace {

/// Calls visit(zone) once for each zone that has leaves of a block.
template <class Visit>
void for_each_zone(const LatticeTree& tree, const Zones& zones, BlockIndex b, const Visit& visit) {
  if (zones.is_whole(b)) return visit(zones.of(b, 0));
  std::vector<ZoneIndex> found;
  for (int child = 0; child < tree.leaf_count(b); ++child) found.push_back(zones.of(b, child));
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  for (const ZoneIndex z : found) visit(z);
}

}  // namespace

std::vector<TakenBlock> take_all(const LatticeTree& tree) {
  std::vector<TakenBlock> taken;
  for (BlockIndex b = 0; b < tree.block_count(); ++b) taken.push_back({b, tree.all_leaves(b)});
  return taken;
}

BlocksOfZones list_blocks(const LatticeTree& tree, const Zones& zones) {
  BlocksOfZones result;
  result.starts.assign(zones.count() + 1, 0);
  for (BlockIndex b = 0; b < tree.block_count(); ++b)
    for_each_zone(tree, zones, b, [&](ZoneIndex z) { ++result.starts[z + 1]; });
  std::partial_sum(result.starts.begin(), result.starts.end(), result.starts.begin());
  result.blocks.resize(result.starts.back());
  std::vector<std::int32_t> next(result.starts.begin(), result.starts.end() - 1);
  for (BlockIndex b = 0; b < tree.block_count(); ++b)
    for_each_zone(tree, zones, b, [&](ZoneIndex z) { result.blocks[next[z]++] = b; });
  return result;
}

HaloTaker::HaloTaker(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
                     const Zones& zones)
    : _frame(frame), _tree(tree), _table(table), _zones(zones), _leaves(tree.block_count(), 0) {}

double HaloTaker::size_of(BlockIndex b) const {
  return std::max(mean_edge_of_cell * _frame.edge(_tree.leaf_level(b)), double{_table.longest_edge[b]});
}

void HaloTaker::add(BlockIndex b, std::uint8_t leaves) {
  if (_leaves[b] == 0) _touched.push_back(b);
  _leaves[b] |= leaves;
}

std::vector<TakenBlock> HaloTaker::take(ZoneIndex zone, std::span<const BlockIndex> own_blocks,
                                        double width) {
  _touched.clear();
  for (const BlockIndex b : own_blocks) {
    const GridBox box = GridBox::of(_tree.cell(b));
    double size = 0;
    _tree.for_each_block_in(box.dilated(0.5), [&](BlockIndex n) { size = std::max(size, size_of(n)); });
    const double reach = _frame.grid_distance(width * size);
    _tree.for_each_block_in(box.dilated(reach), [&](BlockIndex n) {
      if (_leaves[n] == _tree.all_leaves(n)) return;
      if (_zones.is_whole(n) && _zones.of(n, 0) == zone) return add(n, _tree.all_leaves(n));
      std::uint8_t leaves = 0;
      for (int child = 0; child < _tree.leaf_count(n); ++child) {
        const bool taken = _zones.of(n, child) == zone || GridBox::of(_tree.leaf(n, child)).gap_to(box) <= reach;
        if (taken) leaves |= static_cast<std::uint8_t>(1U << child);
      }
      if (leaves != 0) add(n, leaves);
    });
  }
  std::sort(_touched.begin(), _touched.end());
  std::vector<TakenBlock> taken;
  taken.reserve(_touched.size());
  for (const BlockIndex b : _touched) {
    taken.push_back({b, _leaves[b]});
    _leaves[b] = 0;
  }
  return taken;
}

}  // namespace aeroloom::volume
