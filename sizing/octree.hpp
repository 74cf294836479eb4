/// The octree behind the size field: which cells are split, the leaves along the curve, and how a point finds
/// its leaf.
#pragma once

#include "parallel/node_array.hpp"
#include "sizing/morton.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::sizing {

/// An octree as the sets of its split cells, one ascending list of level keys per level (a level key has
/// three bits per level). Splitting a cell splits its ancestors once balance() has run.
class SplitCubes {
public:
  /// Splits the cell of `level` that holds the finest cell `key`.
  void split(std::uint64_t key, int level) { _cells[level].push_back(key >> 3 * (finest_level - level)); }
  /// Splits what it takes to have leaves of at most one level apart across faces, edges and corners.
  void balance();

  /// Leaves along the Morton curve: key of the low corner, level.
  struct Leaves {
    std::vector<std::uint64_t> keys;
    std::vector<std::uint8_t> levels;
  };
  /// After balance().
  Leaves leaves() const;
  /// How many there are, once balanced.
  std::int64_t leaf_count() const {
    std::int64_t split = 0;
    for (const std::vector<std::uint64_t>& cells : _cells) split += static_cast<std::int64_t>(cells.size());
    return 7 * split + 1;
  }

private:
  std::array<std::vector<std::uint64_t>, finest_level> _cells;
};

/// Finds the leaf of a finest cell: a tree with 64 branches per node, two octree levels each.
class LeafTable {
public:
  LeafTable() = default;
  explicit LeafTable(const SplitCubes::Leaves& leaves);

  /// Index of the leaf that holds the finest cell with this key.
  std::int32_t find(std::uint64_t key) const {
    std::int32_t entry = 0;
    for (int shift = top_shift;; shift -= 6) {
      entry = _entries[static_cast<std::size_t>(entry) * 64 + (key >> shift & 63)];
      if (entry >= 0) return entry;
      entry = -entry;
    }
  }
  /// The same table, which is the same on every rank, held once per node. Collective.
  LeafTable shared(const parallel::Communicator& communicator) const;

private:
  static constexpr int top_shift = 3 * finest_level - 6;
  parallel::NodeArray<std::int32_t> _entries;  // (nodes,64): a leaf where >= 0, else minus the node below
};

/// The distinct corners of a range of leaves.
struct OctreeNodes {
  std::vector<GridPoint> points;
  std::vector<std::int32_t> corners;  ///< (leaves of the range,8) node per corner, corners in Morton order

  /// A node in the middle of an edge or face of a leaf next to it. Its masters are that edge's or face's
  /// corners, which in a balanced octree hang nowhere themselves.
  struct Hanging {
    std::int32_t node;
    std::int32_t count;  ///< of masters: 2 or 4
    std::array<GridPoint, 4> masters;
    std::array<std::int32_t, 4> master_nodes;  ///< -1 where that is no corner in the range
  };
  std::vector<Hanging> hanging;  ///< ascending node
};
/// Of the leaves [first, last).
OctreeNodes collect_nodes(const SplitCubes::Leaves& leaves, const LeafTable& table, std::size_t first,
                          std::size_t last);

/// The corners of a leaf that hang on larger leaves beside it: their masters, some more than once.
std::vector<GridPoint> masters_of_corners(const SplitCubes::Leaves& leaves, const LeafTable& table,
                                          std::int32_t leaf);

}  // namespace aeroloom::sizing
