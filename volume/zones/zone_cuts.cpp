#include "volume/zones/zone_cuts.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace aeroloom::volume {

std::vector<CoarseCell> coarsen(const LatticeTree& tree, std::span<const Load> loads, Load most) {
  const BlockIndex first = tree.first(), last = tree.last();
  std::vector<CoarseCell> cells, open{{0, 0, 0, 0, 0}};
  while (!open.empty()) {
    std::vector<CoarseCell> mine;
    BlockIndex b = first;
    for (CoarseCell cell : open) {
      const std::uint64_t end = cell.key + (1ULL << 3 * (sizing::finest_level - cell.level));
      while (b < last && tree.cube(b).key() < cell.key) ++b;
      for (; b < last && tree.cube(b).key() < end; ++b) {
        const GridCube block = tree.cube(b);
        cell.is_block = block.level == cell.level ? 1 : 0;
        cell.load += loads[b - first];
        cell.edges += loads[b - first] * block.edge();
      }
      if (cell.load > 0) mine.push_back(cell);
    }
    std::vector<CoarseCell> all = tree.communicator().all_gather_items<CoarseCell>(mine);
    open.clear();
    for (std::size_t i = 0; i < all.size();) {
      CoarseCell cell = all[i];
      for (++i; i < all.size() && all[i].key == cell.key; ++i) {
        cell.load += all[i].load;
        cell.edges += all[i].edges;
      }
      if (cell.load <= most || cell.is_block) {
        cells.push_back(cell);
        continue;
      }
      const GridCube cube{sizing::grid_point(cell.key), cell.level};
      for (int c = 0; c < 8; ++c) open.push_back({cube.child(c).key(), cell.level + 1, 0, 0, 0});
    }
  }
  std::sort(cells.begin(), cells.end(),
            [](const CoarseCell& a, const CoarseCell& b) { return a.key < b.key; });
  return cells;
}

/// The part of a cell between cuts.
struct ZoneCuts::Part {
  std::array<double, 3> low, high;
  double load, edge;  ///< of its blocks

  /// The load between two planes.
  double between(int axis, double from, double to) const {
    const double within = std::min(to, high[axis]) - std::max(from, low[axis]);
    return within <= 0 ? 0 : load * within / (high[axis] - low[axis]);
  }
};

ZoneCuts::ZoneCuts(std::span<const CoarseCell> cells, ZoneIndex count) : _count(count) {
  std::vector<Part> parts;
  for (const CoarseCell& cell : cells) {
    const GridBox box = GridBox::of({sizing::grid_point(cell.key), cell.level});
    parts.push_back({{box.low.x, box.low.y, box.low.z},
                     {box.high.x, box.high.y, box.high.z},
                     tetrahedra_of(cell.load),
                     static_cast<double>(cell.edges) / static_cast<double>(cell.load)});
  }
  divide(std::move(parts), count);
}

void ZoneCuts::divide(std::vector<Part> parts, ZoneIndex count) {
  if (count == 1) return;
  double total = 0;
  for (const Part& part : parts) total += part.load;
  const ZoneIndex half = count / 2;
  const double target = total * half / count;
  Cut best{0, 0};
  double least = 1e300;
  for (int axis = 0; axis < 3; ++axis) {
    std::uint32_t low = 0,
                  high = 2 * sizing::grid_size;  // twice the place; the load below is at most the target
    while (high - low > 1) {
      const std::uint32_t middle = low + (high - low) / 2;
      double below = 0;
      for (const Part& part : parts) below += part.between(axis, 0, 0.5 * middle);
      (below <= target ? low : high) = middle;
    }
    const double place = 0.5 * low;
    double cost = 0;
    // The cost of a cut is the load in the halos on both sides.
    constexpr double halo = 1.5;  // in edges of the cells, either way
    for (const Part& part : parts)
      cost += part.between(axis, place - halo * part.edge, place + halo * part.edge);
    if (cost < least) least = cost, best = {axis, low};
  }
  _cuts.push_back(best);
  const double place = 0.5 * best.twice_place;
  std::vector<Part> below, above;
  for (const Part& part : parts) {
    Part lower = part, upper = part;
    lower.load = part.between(best.axis, 0, place);
    upper.load = part.load - lower.load;
    lower.high[best.axis] = std::min(part.high[best.axis], place);
    upper.low[best.axis] = std::max(part.low[best.axis], place);
    if (part.low[best.axis] < place) below.push_back(lower);
    if (part.high[best.axis] > place) above.push_back(upper);
  }
  std::vector<Part>().swap(parts);
  divide(std::move(below), half);
  divide(std::move(above), count - half);
}

ZoneIndex ZoneCuts::zone_of_all(const GridCube& cube) const {
  ZoneIndex zone = 0, count = _count;
  for (const Cut* cut = _cuts.data(); count > 1;) {
    const ZoneIndex half = count / 2;
    const Sides sides = sides_of(*cut, cube);
    if (sides.below && sides.above) return no_zone;
    cut += sides.below ? 1 : half;
    zone += sides.below ? 0 : half;
    count = sides.below ? half : count - half;
  }
  return zone;
}

ZoneIndex ZoneCuts::zone_of(const GridCube& block) const {
  const std::uint32_t twice[3] = {2 * block.low.x + block.edge(), 2 * block.low.y + block.edge(),
                                  2 * block.low.z + block.edge()};
  ZoneIndex zone = 0, count = _count;
  const Cut* cut = _cuts.data();
  while (count > 1) {
    const ZoneIndex half = count / 2;
    if (twice[cut->axis] < cut->twice_place) {
      ++cut;
      count = half;
    } else {
      cut += half;
      zone += half;
      count -= half;
    }
  }
  return zone;
}

}  // namespace aeroloom::volume
