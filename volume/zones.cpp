#include "volume/zones.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace aeroloom::volume {

namespace {

/// Blocks with load, sorted along the three axes; a part of it is a range in all three orders.
class Bisection {
public:
  Bisection(const LatticeTree& tree, std::span<const double> loads, std::vector<ZoneIndex>& zones)
      : _loads(loads), _zones(zones) {
    for (BlockIndex b = 0; b < tree.block_count(); ++b) {
      if (loads[b] <= 0) continue;
      const GridCube cell = tree.cube(b);
      const std::uint32_t edge = cell.edge();
      _items.push_back({b, {2 * cell.low.x + edge, 2 * cell.low.y + edge, 2 * cell.low.z + edge}, edge});
    }
    _left.resize(_items.size());
    for (int axis = 0; axis < 3; ++axis) {
      _orders[axis].resize(_items.size());
      std::iota(_orders[axis].begin(), _orders[axis].end(), 0);
      std::sort(_orders[axis].begin(), _orders[axis].end(), [&](std::int32_t i, std::int32_t j) {
        const auto a = _items[i].twice_center[axis], b = _items[j].twice_center[axis];
        return a != b ? a < b : i < j;
      });
    }
  }

  void run(ZoneIndex count) { divide(0, _items.size(), 0, count); }

private:
  struct Item {
    BlockIndex block;
    std::array<std::uint32_t, 3> twice_center;
    std::uint32_t edge;
  };

  void divide(std::size_t first, std::size_t last, ZoneIndex zone, ZoneIndex count) {
    if (count == 1 || last - first < 2) {
      for (std::size_t i = first; i < last; ++i) _zones[_items[_orders[0][i]].block] = zone;
      return;
    }
    double total = 0;
    for (std::size_t i = first; i < last; ++i) total += _loads[_items[_orders[0][i]].block];
    const ZoneIndex half = count / 2;
    const double share = total * half / count;
    int best = 0;
    std::size_t place = first;
    double least = 1e300;
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t cut = cut_at(axis, first, last, share);
      const double cost = cost_of(axis, first, last, cut);
      if (cost < least) least = cost, best = axis, place = cut;
    }
    for (std::size_t i = first; i < last; ++i) _left[_orders[best][i]] = i < place;
    for (auto& order : _orders) {
      std::stable_partition(order.begin() + static_cast<std::ptrdiff_t>(first),
                            order.begin() + static_cast<std::ptrdiff_t>(last),
                            [&](std::int32_t i) { return _left[i] != 0; });
    }
    divide(first, place, zone, count / 2);
    divide(place, last, zone + count / 2, count - count / 2);
  }

  /// Where along an axis the load reaches the share; neither side is empty.
  std::size_t cut_at(int axis, std::size_t first, std::size_t last, double share) const {
    double sum = 0;
    for (std::size_t i = first; i + 1 < last; ++i) {
      sum += _loads[_items[_orders[axis][i]].block];
      if (sum >= share) return i + 1;
    }
    return last - 1;
  }

  /// The load of the blocks that lie within their own width of the cut.
  double cost_of(int axis, std::size_t first, std::size_t last, std::size_t cut) const {
    const std::int64_t plane = _items[_orders[axis][cut]].twice_center[axis];
    double cost = 0;
    for (std::size_t i = first; i < last; ++i) {
      const Item& item = _items[_orders[axis][i]];
      if (std::abs(item.twice_center[axis] - plane) <= 3 * std::int64_t{item.edge})
        cost += _loads[item.block];
    }
    return cost;
  }

  std::span<const double> _loads;
  std::vector<ZoneIndex>& _zones;
  std::vector<Item> _items;
  std::array<std::vector<std::int32_t>, 3> _orders;
  std::vector<char> _left;
};

}  // namespace

ZoneIndex Zones::find(BlockIndex b, int child) const {
  const LeafNumber leaf = leaf_number({b, child});
  const auto at = std::lower_bound(_given.begin(), _given.end(), leaf,
                                   [](const Given& given, LeafNumber wanted) { return given.leaf < wanted; });
  return at != _given.end() && at->leaf == leaf ? at->zone : _of_block[b];
}

bool Zones::is_whole(BlockIndex b) const {
  const auto at = std::lower_bound(_given.begin(), _given.end(), leaf_number({b, 0}),
                                   [](const Given& given, LeafNumber wanted) { return given.leaf < wanted; });
  return at == _given.end() || at->leaf >= leaf_number({b + 1, 0});
}

void Zones::give(BlockIndex b, int child, ZoneIndex zone) {
  const LeafNumber leaf = leaf_number({b, child});
  const auto at = std::lower_bound(_given.begin(), _given.end(), leaf,
                                   [](const Given& given, LeafNumber wanted) { return given.leaf < wanted; });
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

std::vector<double> block_loads(const SurfaceTable& table, std::span<const std::uint8_t> points,
                                std::span<const std::uint8_t> borders) {
  std::vector<double> loads(points.size());
  for (std::size_t b = 0; b < points.size(); ++b)
    loads[b] = std::max(0.0, tetrahedra_per_point * points[b] + tetrahedra_per_triangle * table.triangles[b] -
                                 fewer_per_border * borders[b]);
  return loads;
}

ZoneIndex wanted_zones(double expected_tetrahedra, std::int64_t piece_tets) {
  constexpr double whole_below = 1.5;
  const double zones = expected_tetrahedra / static_cast<double>(piece_tets);
  if (zones < whole_below) return 1;
  const double unit = std::exp2(std::max(0, std::ilogb(zones) - 2));
  return static_cast<ZoneIndex>(unit * std::round(zones / unit));
}

Zones bisect(const LatticeTree& tree, std::span<const double> loads, ZoneIndex count) {
  std::vector<ZoneIndex> zones(tree.block_count(), no_zone);
  if (count == 1) return {std::vector<ZoneIndex>(tree.block_count(), 0), 1};
  Bisection(tree, loads, zones).run(count);
  ZoneIndex before = 0;
  for (ZoneIndex& zone : zones) {
    if (zone == no_zone) zone = before;
    before = zone;
  }
  return {std::move(zones), count};
}

}  // namespace aeroloom::volume
