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
    : _frame(frame),
      _tree(tree),
      _table(table),
      _zones(zones),
      _leaves(tree.block_count(), 0),
      _seen(tree.block_count(), 0),
      _sizes(tree.block_count(), 0) {}

double largest_size_around(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
                           BlockIndex b) {
  double size = 0;
  tree.for_each_block_in(GridBox::of(tree.cell(b)).dilated(0.5), [&](BlockIndex n) {
    size =
        std::max({size, mean_edge_of_cell * frame.edge(tree.leaf_level(n)), double{table.longest_edge[n]}});
  });
  return size;
}

void NearBoxes::build() {
  std::size_t nodes = 1;
  while (nodes < 2 * _boxes.size()) nodes *= 2;
  _nodes.assign(nodes, {});
  if (!_boxes.empty()) build(0, 0, _boxes.size());
}

GridBox NearBoxes::build(std::size_t node, std::size_t first, std::size_t last) {
  if (last - first == 1) return _nodes[node] = _boxes[first];
  const std::size_t middle = first + (last - first) / 2;
  const GridBox a = build(2 * node + 1, first, middle), b = build(2 * node + 2, middle, last);
  return _nodes[node] = {
             {std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y), std::min(a.low.z, b.low.z)},
             {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y), std::max(a.high.z, b.high.z)}};
}

bool NearBoxes::any_below(std::size_t node, std::size_t first, std::size_t last, const GridBox& box,
                          double reach) const {
  if (_nodes[node].gap_to(box) > reach) return false;
  if (last - first == 1) return true;
  const std::size_t middle = first + (last - first) / 2;
  return any_below(2 * node + 1, first, middle, box, reach) ||
         any_below(2 * node + 2, middle, last, box, reach);
}

/// Queues the blocks next to one. Whether there are any of other zones.
bool HaloTaker::look_around(BlockIndex b) {
  bool others = false;
  _tree.for_each_block_in(GridBox::of(_tree.cell(b)).dilated(0.5), [&](BlockIndex n) {
    others = others || !is_all_own(n);
    if (_seen[n]) return;
    _seen[n] = 1;
    _queue.push_back(n);
  });
  return others;
}

/// Takes what the zone has itself, and lists what of it is beside others.
void HaloTaker::list_border(std::span<const BlockIndex> own_blocks) {
  _border.clear();
  for (const BlockIndex b : own_blocks) {
    if (is_all_own(b)) {
      if (!_seen[b]) _queue.push_back(b);
      _seen[b] = 1;
      _leaves[b] = _tree.all_leaves(b);
      if (look_around(b)) _border.add(GridBox::of(_tree.cell(b)));
      continue;
    }
    for (int child = 0; child < _tree.leaf_count(b); ++child) {
      if (!is_own(b, child)) continue;
      _leaves[b] |= static_cast<std::uint8_t>(1U << child);
      _border.add(GridBox::of(_tree.leaf(b, child)));
    }
    look_around(b);
  }
  _border.build();
}

double HaloTaker::size_around(BlockIndex b) {
  if (_sizes[b] == 0) _sizes[b] = static_cast<float>(largest_size_around(_frame, _tree, _table, b));
  return _sizes[b];
}

/// Takes the leaves of a block that are near enough. Looks further where it is nearly so.
void HaloTaker::judge(BlockIndex b, double width) {
  constexpr double nearly = 1.5;
  const GridBox box = GridBox::of(_tree.cell(b));
  const double reach = _frame.grid_distance(width * size_around(b));
  if (!_border.any_within(box, nearly * reach)) return;
  look_around(b);
  if (!_border.any_within(box, reach)) return;
  for (int child = 0; child < _tree.leaf_count(b); ++child) {
    if (_border.any_within(GridBox::of(_tree.leaf(b, child)), reach))
      _leaves[b] |= static_cast<std::uint8_t>(1U << child);
  }
}

std::vector<TakenBlock> HaloTaker::take(ZoneIndex zone, std::span<const BlockIndex> own_blocks,
                                        double width) {
  _zone = zone;
  _queue.clear();
  list_border(own_blocks);
  for (std::size_t i = 0; i < _queue.size(); ++i) {
    if (_leaves[_queue[i]] != _tree.all_leaves(_queue[i])) judge(_queue[i], width);
  }
  std::vector<TakenBlock> taken;
  taken.reserve(_queue.size());
  for (const BlockIndex b : _queue) {
    if (_leaves[b] != 0) taken.push_back({b, _leaves[b]});
    _leaves[b] = _seen[b] = 0;
  }
  std::sort(taken.begin(), taken.end(),
            [](const TakenBlock& a, const TakenBlock& b) { return a.block < b.block; });
  return taken;
}

}  // namespace aeroloom::volume
