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
  found.reserve(tree.leaf_count(b));
  for (int child = 0; child < tree.leaf_count(b); ++child) found.push_back(zones.of(b, child));
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  for (const ZoneIndex z : found) visit(z);
}

}  // namespace

std::vector<TakenBlock> take_all(const LatticeTree& tree) {
  std::vector<TakenBlock> taken;
  taken.reserve(tree.block_count());
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

double largest_size_around(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
                           BlockIndex b) {
  double size = 0;
  tree.for_each_block_in(GridBox::of(tree.cube(b)).dilated(0.5), [&](BlockIndex n) {
    size =
        std::max({size, mean_edge_of_cell * frame.edge(tree.leaf_level(n)), double{table.longest_edge[n]}});
  });
  return size;
}

ZoneSurroundings::ZoneSurroundings(const LatticeFrame& frame, const LatticeTree& tree,
                                   const SurfaceTable& table, const Zones& zones)
    : _frame(frame),
      _tree(tree),
      _table(table),
      _zones(zones),
      _sizes(tree.block_count(), 0),
      _alike_to(tree.block_count()) {
  for (BlockIndex b = tree.block_count(); b-- > 0;) {
    const bool goes_on = b + 1 < tree.block_count() && zones.is_whole(b) && zones.is_whole(b + 1) &&
                         zones.of(b, 0) == zones.of(b + 1, 0);
    _alike_to[b] = goes_on ? _alike_to[b + 1] : b + 1;
  }
}

bool ZoneSurroundings::is_beside_others(BlockIndex b) const {
  return _tree.any_block_in(
      GridBox::of(_tree.cube(b)).dilated(0.5), [&](BlockIndex n) { return !is_all_own(n); },
      [&](BlockIndex first, BlockIndex last) { return _alike_to[first] >= last && is_all_own(first); });
}

void ZoneSurroundings::move_to(ZoneIndex zone, std::span<const BlockIndex> own_blocks) {
  _zone = zone;
  _border.clear();
  _boxes.clear();
  for (const BlockIndex b : own_blocks) {
    if (!is_beside_others(b)) continue;
    _border.push_back(b);
    if (is_all_own(b)) {
      _boxes.add(GridBox::of(_tree.cube(b)));
      continue;
    }
    for (int child = 0; child < _tree.leaf_count(b); ++child) {
      if (is_own(b, child)) _boxes.add(GridBox::of(_tree.leaf(b, child)));
    }
  }
  _boxes.build();
}

double ZoneSurroundings::size_around(BlockIndex b) {
  if (_sizes[b] == 0) _sizes[b] = static_cast<float>(largest_size_around(_frame, _tree, _table, b));
  return _sizes[b];
}

HaloTaker::HaloTaker(const LatticeFrame& frame, const LatticeTree& tree, const SurfaceTable& table,
                     const Zones& zones)
    : _tree(tree),
      _surroundings(frame, tree, table, zones),
      _leaves(tree.block_count(), 0),
      _seen(tree.block_count(), 0) {}

/// Queues the blocks next to one.
void HaloTaker::look_around(BlockIndex b) {
  _tree.for_each_block_in(GridBox::of(_tree.cube(b)).dilated(0.5), [&](BlockIndex n) {
    if (_seen[n]) return;
    _seen[n] = 1;
    _queue.push_back(n);
  });
}

/// Takes what the zone has itself.
void HaloTaker::take_own(std::span<const BlockIndex> own_blocks) {
  for (const BlockIndex b : own_blocks) {
    for (int child = 0; child < _tree.leaf_count(b); ++child) {
      if (_surroundings.is_own(b, child)) _leaves[b] |= static_cast<std::uint8_t>(1U << child);
    }
    _seen[b] = 1;
    _queue.push_back(b);
  }
  for (const BlockIndex b : _surroundings.border()) look_around(b);
}

/// Takes the leaves of a block that are near enough. Looks further where it is nearly so.
void HaloTaker::judge(BlockIndex b, double width) {
  constexpr double nearly = 1.5;
  const GridBox box = GridBox::of(_tree.cube(b));
  if (!_surroundings.is_near(box, b, nearly * width)) return;
  look_around(b);
  if (!_surroundings.is_near(box, b, width)) return;
  for (int child = 0; child < _tree.leaf_count(b); ++child) {
    if (_surroundings.is_near(GridBox::of(_tree.leaf(b, child)), b, width))
      _leaves[b] |= static_cast<std::uint8_t>(1U << child);
  }
}

std::vector<TakenBlock> HaloTaker::take(ZoneIndex zone, std::span<const BlockIndex> own_blocks,
                                        double width) {
  _surroundings.move_to(zone, own_blocks);
  _queue.clear();
  take_own(own_blocks);
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
