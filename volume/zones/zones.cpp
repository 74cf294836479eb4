#include "volume/zones/zones.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace aeroloom::volume {

namespace {

bool in_order(const ReassignedLeaf& a, const ReassignedLeaf& b) {
  return std::tie(a.block, a.child) < std::tie(b.block, b.child);
}

bool along_curve(const GridCube& a, const GridCube& b) {
  return a.key() < b.key();
}

}  // namespace

Zones::Zones(const LatticeTree& tree, ZoneCuts cuts, std::vector<GridCube> cut_ghosts)
    : _tree(tree), _cuts(std::move(cuts)), _cut_ghosts(std::move(cut_ghosts)), _names(count()) {
  std::sort(_cut_ghosts.begin(), _cut_ghosts.end(), along_curve);
  std::iota(_names.begin(), _names.end(), 0);
  _of_block.reserve(tree.block_count());
  for (BlockIndex b = 0; b < tree.block_count(); ++b) _of_block.push_back(_cuts.zone_of(tree.cube(b)));
}

ZoneIndex Zones::find(BlockIndex b, int child) const {
  const ReassignedLeaf leaf{_tree.number(b), child, {}, 0};
  const auto at = std::lower_bound(_reassigned.begin(), _reassigned.end(), leaf, in_order);
  return at != _reassigned.end() && !in_order(leaf, *at) ? at->zone : _of_block[b];
}

bool Zones::is_whole(BlockIndex b) const {
  const auto at = std::lower_bound(_reassigned.begin(), _reassigned.end(),
                                   ReassignedLeaf{_tree.number(b), 0, {}, 0}, in_order);
  return at == _reassigned.end() || at->block != _tree.number(b);
}

bool Zones::has(ZoneIndex zone, BlockIndex b) const {
  if (is_whole(b)) return of(b, 0) == zone;
  for (int child = 0; child < _tree.leaf_count(b); ++child) {
    if (of(b, child) == zone) return true;
  }
  return false;
}

bool Zones::is_block(const GridCube& cube) const {
  const BlockIndex b = _tree.any_at(cube.low);
  if (_tree.is_local(b)) return _tree.level(b) == cube.level;
  const auto at = std::lower_bound(_cut_ghosts.begin(), _cut_ghosts.end(), cube, along_curve);
  return at != _cut_ghosts.end() && *at == cube;
}

void Zones::reassign(const ReassignedLeaf& leaf) {
  const auto at = std::lower_bound(_reassigned.begin(), _reassigned.end(), leaf, in_order);
  if (at != _reassigned.end() && !in_order(leaf, *at))
    *at = leaf;
  else
    _reassigned.insert(at, leaf);
}

void Zones::merge(ZoneIndex from, ZoneIndex to) {
  std::replace(_of_block.begin(), _of_block.end(), from, to);
  std::replace(_names.begin(), _names.end(), from, to);
  for (ReassignedLeaf& leaf : _reassigned) {
    if (leaf.zone == from) leaf.zone = to;
  }
}

std::vector<std::int64_t> Zones::sum(std::vector<std::int64_t> mine) const {
  struct ZoneValue {
    ZoneIndex zone;
    std::int64_t value;
  };
  std::vector<ZoneValue> rows;
  for (std::size_t z = 0; z < mine.size(); ++z) {
    if (mine[z] != 0) rows.push_back({static_cast<ZoneIndex>(z), std::exchange(mine[z], 0)});
  }
  for (const ZoneValue& row : _tree.communicator().all_gather_items<ZoneValue>(rows))
    mine[row.zone] += row.value;
  return mine;
}

ZoneIndex wanted_zones(double expected_tetrahedra, std::int64_t piece_tets) {
  constexpr double whole_below = 1.5;  // from here on two zones are nearer to what is wanted than one
  const double zones = expected_tetrahedra / static_cast<double>(piece_tets);
  if (zones < whole_below) return 1;
  const double unit = std::exp2(std::max(0, std::ilogb(zones) - 2));
  return static_cast<ZoneIndex>(unit * std::round(zones / unit));
}

}  // namespace aeroloom::volume
