#include "volume/zones/zones.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace aeroloom::volume {

namespace {

bool in_order(const GivenLeaf& a, const GivenLeaf& b) {
  return std::tie(a.block, a.child) < std::tie(b.block, b.child);
}

}  // namespace

Zones::Zones(const LatticeTree& tree, ZoneCuts cuts) : _tree(tree), _cuts(std::move(cuts)), _names(count()) {
  std::iota(_names.begin(), _names.end(), 0);
  _of_block.reserve(tree.block_count());
  for (BlockIndex b = 0; b < tree.block_count(); ++b) _of_block.push_back(_cuts.zone_of(tree.cube(b)));
}

ZoneIndex Zones::find(BlockIndex b, int child) const {
  const GivenLeaf leaf{_tree.number(b), child, {}, 0};
  const auto at = std::lower_bound(_given.begin(), _given.end(), leaf, in_order);
  return at != _given.end() && !in_order(leaf, *at) ? at->zone : _of_block[b];
}

bool Zones::is_whole(BlockIndex b) const {
  const auto at =
      std::lower_bound(_given.begin(), _given.end(), GivenLeaf{_tree.number(b), 0, {}, 0}, in_order);
  return at == _given.end() || at->block != _tree.number(b);
}

bool Zones::has(ZoneIndex zone, BlockIndex b) const {
  if (is_whole(b)) return of(b, 0) == zone;
  for (int child = 0; child < _tree.leaf_count(b); ++child) {
    if (of(b, child) == zone) return true;
  }
  return false;
}

void Zones::give(const GivenLeaf& leaf) {
  const auto at = std::lower_bound(_given.begin(), _given.end(), leaf, in_order);
  if (at != _given.end() && !in_order(leaf, *at))
    *at = leaf;
  else
    _given.insert(at, leaf);
}

void Zones::merge(ZoneIndex from, ZoneIndex to) {
  std::replace(_of_block.begin(), _of_block.end(), from, to);
  std::replace(_names.begin(), _names.end(), from, to);
  for (GivenLeaf& given : _given) {
    if (given.zone == from) given.zone = to;
  }
}

std::vector<std::int64_t> sum_by_zone(const parallel::Communicator& communicator,
                                      std::vector<std::int64_t> mine) {
  struct ZoneValue {
    ZoneIndex zone;
    std::int64_t value;
    static constexpr auto fields() { return std::tuple(&ZoneValue::zone, &ZoneValue::value); }
  };
  std::vector<ZoneValue> rows;
  for (std::size_t z = 0; z < mine.size(); ++z) {
    if (mine[z] != 0) rows.push_back({static_cast<ZoneIndex>(z), std::exchange(mine[z], 0)});
  }
  for (const ZoneValue& row : communicator.all_gather_items<ZoneValue>(rows)) mine[row.zone] += row.value;
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
