#include "sizing/field/octree.hpp"

#include <algorithm>

namespace aeroloom::sizing {
namespace {

/// The corner of a leaf that has the given offset bits.
GridPoint corner_point(GridPoint low, std::uint32_t edge, int corner) {
  return {low.x + (corner & 1 ? edge : 0), low.y + (corner & 2 ? edge : 0), low.z + (corner & 4 ? edge : 0)};
}

/// Whether a leaf of this edge that touches the node has it as a corner.
bool is_corner(GridPoint p, std::uint32_t edge) {
  return ((p.x | p.y | p.z) & (edge - 1)) == 0;
}

/// Finds the leaves in the eight octants around a corner of `leaf`, -1 outside, until a leaf before it, but
/// not before `first`, turns up that has the node as a corner too: then returns that octant, else -1.
int find_leaves_around(GridPoint p, std::int32_t leaf, std::int32_t first, CellSpans leaves,
                       const LeafTable& table, std::array<std::int32_t, 8>& around) {
  for (int octant = 0; octant < 8; ++octant) {
    const GridPoint cell{p.x - (octant & 1 ? 0 : 1), p.y - (octant & 2 ? 0 : 1), p.z - (octant & 4 ? 0 : 1)};
    const bool inside = cell.x < grid_size && cell.y < grid_size && cell.z < grid_size;
    const std::int32_t found = inside ? table.find(morton_key(cell)) : -1;
    around[octant] = found;
    if (found >= first && found < leaf && is_corner(p, grid_size >> leaves.levels[found])) return octant;
  }
  return -1;
}

/// The masters of a node that lies on an edge or face of the given leaf: its corners that agree with the node
/// on every axis where the node is no middle; `master_nodes` says which corners.
OctreeNodes::Hanging hang(std::int32_t node, GridPoint p, std::int32_t leaf, CellSpans leaves) {
  const std::uint32_t edge = grid_size >> leaves.levels[leaf], inside = edge - 1;
  const GridPoint low = grid_point(leaves.keys[leaf]);
  const auto agrees = [&](std::uint32_t at, std::uint32_t from, bool high) {
    return (at & inside) != 0 || at == from + (high ? edge : 0);
  };
  OctreeNodes::Hanging hanging{node, 0, {}, {-1, -1, -1, -1}};
  for (int corner = 0; corner < 8; ++corner) {
    if (!agrees(p.x, low.x, corner & 1) || !agrees(p.y, low.y, corner & 2) || !agrees(p.z, low.z, corner & 4))
      continue;
    hanging.masters[hanging.count] = corner_point(low, edge, corner);
    hanging.master_nodes[hanging.count++] = corner;
  }
  return hanging;
}

/// The octant of a leaf around a node that has the node on an edge or face, -1 where none does.
int octant_to_hang_on(GridPoint p, const std::array<std::int32_t, 8>& around, CellSpans leaves) {
  for (int octant = 0; octant < 8; ++octant) {
    if (around[octant] >= 0 && !is_corner(p, grid_size >> leaves.levels[around[octant]])) return octant;
  }
  return -1;
}

/// Corners met lately: most are shared with leaves a little further back on the curve.
class RecentNodes {
public:
  /// The node at a point, -1 where it was not met lately.
  std::int32_t find(GridPoint p) const {
    const Slot& slot = _slots[slot_of(p)];
    return slot.point == p ? slot.node : -1;
  }
  void keep(GridPoint p, std::int32_t node) { _slots[slot_of(p)] = {p, node}; }

private:
  struct Slot {
    GridPoint point;
    std::int32_t node = -1;
  };
  static constexpr int bits = 14;  // 16,384 slots; chosen, not measured

  static std::size_t slot_of(GridPoint p) {
    // Odd numbers without a pattern in their bits: the golden ratio and two of the hash xxh64.
    const std::uint64_t mixed =
        p.x * 0x9e3779b97f4a7c15ULL ^ p.y * 0xc2b2ae3d27d4eb4fULL ^ p.z * 0x165667b19e3779f9ULL;
    return static_cast<std::size_t>(mixed >> (64 - bits));
  }

  std::vector<Slot> _slots = std::vector<Slot>(std::size_t{1} << bits);
};

}  // namespace

OctreeNodes collect_nodes(CellSpans leaves, const LeafTable& table, IndexRange range) {
  const auto [first, last] = range;
  OctreeNodes nodes;
  std::vector<std::int32_t> hung_on;  // per hanging node
  RecentNodes recent;
  nodes.corners.resize(8 * (last - first));
  for (std::size_t leaf = first; leaf < last; ++leaf) {
    const GridPoint low = grid_point(leaves.keys[leaf]);
    for (int corner = 0; corner < 8; ++corner) {
      const GridPoint p = corner_point(low, grid_size >> leaves.levels[leaf], corner);
      std::int32_t& node = nodes.corners[8 * (leaf - first) + corner];
      node = recent.find(p);
      if (node >= 0) continue;
      std::array<std::int32_t, 8> around{};
      const int earlier = find_leaves_around(p, static_cast<std::int32_t>(leaf),
                                             static_cast<std::int32_t>(first), leaves, table, around);
      if (earlier >= 0) {
        node = nodes.corners[8 * (static_cast<std::size_t>(around[earlier]) - first) + (7 ^ earlier)];
        recent.keep(p, node);
        continue;
      }
      node = static_cast<std::int32_t>(nodes.points.size());
      nodes.points.push_back(p);
      recent.keep(p, node);
      const int octant = octant_to_hang_on(p, around, leaves);
      if (octant < 0) continue;
      nodes.hanging.push_back(hang(node, p, around[octant], leaves));
      hung_on.push_back(around[octant]);
    }
  }
  // Which of their corners are nodes is known when all are.
  for (std::size_t h = 0; h < hung_on.size(); ++h) {
    const auto leaf = static_cast<std::size_t>(hung_on[h]);
    OctreeNodes::Hanging& hanging = nodes.hanging[h];
    for (int i = 0; i < hanging.count; ++i) {
      std::int32_t& node = hanging.master_nodes[i];
      node = leaf >= first && leaf < last ? nodes.corners[8 * (leaf - first) + node] : -1;
    }
  }
  return nodes;
}

std::vector<GridPoint> masters_of_corners(CellSpans leaves, const LeafTable& table, std::int32_t leaf) {
  std::vector<GridPoint> masters;
  if (leaves.levels[leaf] == 0) return masters;
  const GridPoint low = grid_point(leaves.keys[leaf]);
  const std::uint32_t edge = grid_size >> leaves.levels[leaf];
  // Within its parent all leaves are as small; only what the parent touches on the leaf's side may be larger.
  const auto beside = [&](int sides) -> std::int32_t {
    const auto step = [&](std::uint32_t at, bool towards) {
      return towards ? ((at & edge) != 0 ? at + edge : at - 1) : at;
    };
    const GridPoint cell{step(low.x, sides & 1), step(low.y, sides & 2), step(low.z, sides & 4)};
    const bool inside = cell.x < grid_size && cell.y < grid_size && cell.z < grid_size;
    const std::int32_t found = inside ? table.find(morton_key(cell)) : -1;
    return found >= 0 && leaves.levels[found] < leaves.levels[leaf] ? found : -1;
  };
  std::array<std::int32_t, 8> larger{};
  for (int sides = 1; sides < 7; ++sides) larger[sides] = beside(sides);
  for (int corner = 0; corner < 8; ++corner) {
    const GridPoint p = corner_point(low, edge, corner);
    // The sides of the parent that this corner lies on.
    const int sides = (is_corner({p.x, 0, 0}, 2 * edge) ? 1 : 0) |
                      (is_corner({0, p.y, 0}, 2 * edge) ? 2 : 0) | (is_corner({0, 0, p.z}, 2 * edge) ? 4 : 0);
    if (sides == 0 || sides == 7) continue;
    for (int some = sides; some > 0; some = (some - 1) & sides) {
      if (larger[some] < 0) continue;
      const OctreeNodes::Hanging hanging = hang(0, p, larger[some], leaves);
      masters.insert(masters.end(), hanging.masters.begin(), hanging.masters.begin() + hanging.count);
      break;
    }
  }
  return masters;
}

}  // namespace aeroloom::sizing
