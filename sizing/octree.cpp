#include "sizing/octree.hpp"

#include <algorithm>

namespace aeroloom::sizing {
namespace {

void sort_unique(std::vector<std::uint64_t>& keys) {
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

/// The corner of a leaf that has the given offset bits.
GridPoint corner_point(GridPoint low, std::uint32_t edge, int corner) {
  return {low.x + (corner & 1 ? edge : 0), low.y + (corner & 2 ? edge : 0), low.z + (corner & 4 ? edge : 0)};
}

/// Whether a leaf of this edge that touches the node has it as a corner.
bool is_corner(GridPoint p, std::uint32_t edge) {
  return ((p.x | p.y | p.z) & (edge - 1)) == 0;
}

/// Finds the leaves in the eight octants around a corner of `leaf`, -1 outside, until an earlier leaf turns
/// up that has the node as a corner too: then returns that octant, else -1.
int find_leaves_around(GridPoint p, std::int32_t leaf, const SplitCubes::Leaves& leaves,
                       const LeafTable& table, std::array<std::int32_t, 8>& around) {
  for (int octant = 0; octant < 8; ++octant) {
    const GridPoint cell{p.x - (octant & 1 ? 0 : 1), p.y - (octant & 2 ? 0 : 1), p.z - (octant & 4 ? 0 : 1)};
    const bool inside = cell.x < grid_size && cell.y < grid_size && cell.z < grid_size;
    const std::int32_t found = inside ? table.find(morton_key(cell)) : -1;
    around[octant] = found;
    if (found >= 0 && found < leaf && is_corner(p, grid_size >> leaves.levels[found])) return octant;
  }
  return -1;
}

/// Appends the masters of a node that lies on an edge or face of the given leaf.
void hang(std::int32_t node, GridPoint p, std::int32_t leaf, const SplitCubes::Leaves& leaves,
          OctreeNodes& nodes) {
  const std::uint32_t edge = grid_size >> leaves.levels[leaf], inside = edge - 1;
  const GridPoint low = grid_point(leaves.keys[leaf]);
  // Corners of the leaf that agree with the node on every axis where the node is no middle.
  const auto agrees = [&](std::uint32_t at, std::uint32_t from, bool high) {
    return (at & inside) != 0 || at == from + (high ? edge : 0);
  };
  OctreeNodes::Hanging hanging{node, 0, {}};
  for (int corner = 0; corner < 8; ++corner) {
    if (agrees(p.x, low.x, corner & 1) && agrees(p.y, low.y, corner & 2) && agrees(p.z, low.z, corner & 4)) {
      hanging.masters[hanging.count++] = nodes.corners[8 * static_cast<std::size_t>(leaf) + corner];
    }
  }
  nodes.hanging.push_back(hanging);
}

}  // namespace

void SplitCubes::balance() {
  for (int level = finest_level - 1; level > 0; --level) {
    sort_unique(_cells[level]);
    // A split cell needs neighbours of its own level: their parents, itself included, must be split.
    std::vector<std::uint64_t>& parents = _cells[level - 1];
    const std::uint32_t range = 1U << (level - 1);
    for (const std::uint64_t key : _cells[level]) {
      const GridPoint c = grid_point(key);
      for (int side = 0; side < 8; ++side) {
        const GridPoint p{(c.x >> 1) + (side & 1 ? (c.x & 1 ? 1U : ~0U) : 0U),
                          (c.y >> 1) + (side & 2 ? (c.y & 1 ? 1U : ~0U) : 0U),
                          (c.z >> 1) + (side & 4 ? (c.z & 1 ? 1U : ~0U) : 0U)};
        if (p.x < range && p.y < range && p.z < range) parents.push_back(morton_key(p));
      }
    }
  }
  sort_unique(_cells[0]);
}

SplitCubes::Leaves SplitCubes::leaves() const {
  Leaves result;
  std::array<std::size_t, finest_level> next{};
  // Cells are met in Morton order, so on each level the split ones are met in the order of their list.
  const auto visit = [&](auto&& self, std::uint64_t key, int level) -> void {
    if (level < finest_level && next[level] < _cells[level].size() && _cells[level][next[level]] == key) {
      ++next[level];
      for (std::uint64_t child = 0; child < 8; ++child) self(self, key << 3 | child, level + 1);
    } else {
      result.keys.push_back(key << 3 * (finest_level - level));
      result.levels.push_back(static_cast<std::uint8_t>(level));
    }
  };
  visit(visit, 0, 0);
  return result;
}

LeafTable::LeafTable(const SplitCubes::Leaves& leaves) : _entries(64, 0) {
  for (std::size_t leaf = 0; leaf < leaves.keys.size(); ++leaf) {
    const std::uint64_t key = leaves.keys[leaf];
    const int level = leaves.levels[leaf];
    std::size_t node = 0;
    int shift = top_shift, depth = 2;
    for (; depth < level; depth += 2, shift -= 6) {
      std::int32_t& entry = _entries[node * 64 + (key >> shift & 63)];
      if (entry >= 0) {
        entry = -static_cast<std::int32_t>(_entries.size() / 64);
        node = static_cast<std::size_t>(-entry);
        _entries.resize(_entries.size() + 64, 0);
      } else {
        node = static_cast<std::size_t>(-entry);
      }
    }
    const std::size_t first = node * 64 + (key >> shift & 63);
    std::fill_n(_entries.begin() + static_cast<std::ptrdiff_t>(first), 1ULL << 3 * (depth - level),
                static_cast<std::int32_t>(leaf));
  }
}

OctreeNodes collect_nodes(const SplitCubes::Leaves& leaves, const LeafTable& table) {
  OctreeNodes nodes;
  nodes.corners.resize(8 * leaves.keys.size());
  for (std::size_t leaf = 0; leaf < leaves.keys.size(); ++leaf) {
    const GridPoint low = grid_point(leaves.keys[leaf]);
    for (int corner = 0; corner < 8; ++corner) {
      const GridPoint p = corner_point(low, grid_size >> leaves.levels[leaf], corner);
      std::array<std::int32_t, 8> around{};
      const int earlier = find_leaves_around(p, static_cast<std::int32_t>(leaf), leaves, table, around);
      std::int32_t& node = nodes.corners[8 * leaf + corner];
      if (earlier >= 0) {
        node = nodes.corners[8 * static_cast<std::size_t>(around[earlier]) + (7 ^ earlier)];
        continue;
      }
      node = static_cast<std::int32_t>(nodes.points.size());
      nodes.points.push_back(p);
      nodes.leaf_around.insert(nodes.leaf_around.end(), around.begin(), around.end());
    }
  }
  for (std::size_t n = 0; n < nodes.points.size(); ++n) {
    const std::int32_t* around = nodes.leaf_around.data() + 8 * n;
    for (int octant = 0; octant < 8; ++octant) {
      if (around[octant] < 0 || is_corner(nodes.points[n], grid_size >> leaves.levels[around[octant]]))
        continue;
      hang(static_cast<std::int32_t>(n), nodes.points[n], around[octant], leaves, nodes);
      break;
    }
  }
  return nodes;
}

}  // namespace aeroloom::sizing
