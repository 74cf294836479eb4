#include "volume/zones.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace aeroloom::volume {

Zones::Zones(const LatticeTree& tree, const ZoneCuts& cuts) : _count(cuts.count()) {
  _of_block.reserve(tree.block_count());
  for (BlockIndex b = 0; b < tree.block_count(); ++b) _of_block.push_back(cuts.zone_of(tree.cube(b)));
}

ZoneIndex Zones::find(BlockIndex b, int child) const {
  const std::int64_t leaf = place_of(b, child);
  const auto at =
      std::lower_bound(_given.begin(), _given.end(), leaf,
                       [](const Given& given, std::int64_t wanted) { return given.leaf < wanted; });
  return at != _given.end() && at->leaf == leaf ? at->zone : _of_block[b];
}

bool Zones::is_whole(BlockIndex b) const {
  const auto at =
      std::lower_bound(_given.begin(), _given.end(), place_of(b, 0),
                       [](const Given& given, std::int64_t wanted) { return given.leaf < wanted; });
  return at == _given.end() || at->leaf >= place_of(b + 1, 0);
}

void Zones::give(BlockIndex b, int child, ZoneIndex zone) {
  const std::int64_t leaf = place_of(b, child);
  const auto at =
      std::lower_bound(_given.begin(), _given.end(), leaf,
                       [](const Given& given, std::int64_t wanted) { return given.leaf < wanted; });
  if (at != _given.end() && at->leaf == leaf)
    at->zone = zone;
  else
    _given.insert(at, {leaf, zone});
}

void Zones::merge(ZoneIndex from, ZoneIndex to) {
  std::replace(_of_block.begin(), _of_block.end(), from, to);
  for (Given& given : _given) {
    if (given.zone == from) given.zone = to;
  }
}

std::vector<std::int64_t> sum_by_zone(const parallel::Communicator& communicator,
                                      std::vector<std::int64_t> mine) {
  struct Row {
    ZoneIndex zone;
    std::int64_t value;
    static constexpr auto fields() { return std::tuple(&Row::zone, &Row::value); }
  };
  std::vector<Row> rows;
  for (std::size_t z = 0; z < mine.size(); ++z) {
    if (mine[z] != 0) rows.push_back({static_cast<ZoneIndex>(z), std::exchange(mine[z], 0)});
  }
  for (const Row& row : communicator.all_gather_items<Row>(rows)) mine[row.zone] += row.value;
  return mine;
}

ZoneIndex wanted_zones(double expected_tetrahedra, std::int64_t piece_tets) {
  constexpr double whole_below = 1.5;
  const double zones = expected_tetrahedra / static_cast<double>(piece_tets);
  if (zones < whole_below) return 1;
  const double unit = std::exp2(std::max(0, std::ilogb(zones) - 2));
  return static_cast<ZoneIndex>(unit * std::round(zones / unit));
}

}  // namespace aeroloom::volume
