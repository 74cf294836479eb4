/// The octree of a size field: its split cells, its leaves along the Morton curve, and the leaf of a point.
#pragma once

#include "parallel/communication/node_array.hpp"
#include "sizing/field/subtrees.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::sizing {

/// An octree, held as the sets of its split cells: one ascending list of level keys for each level. A level
/// key has three bits for each level. balance() also splits all ancestors of a split cell. Each rank holds
/// the cells of its own subtrees. A cell that holds several subtrees is always split.
class SplitCubes {
public:
  /// The whole octree on this rank.
  SplitCubes() = default;
  explicit SplitCubes(Subtrees subtrees);

  /// Splits the cell of `level` that holds the finest cell `key`. It must lie in a subtree of this rank.
  void split(std::uint64_t key, int level) {
    if (level >= _subtrees.level(_subtrees.find(key)))
      _cells[level].push_back(key >> 3 * (finest_level - level));
  }
  /// Splits cells until leaves that touch differ by at most one level. Collective, as leaf_count().
  void balance();

  const Subtrees& subtrees() const { return _subtrees; }
  /// The subtrees of this rank.
  IndexRange own_subtrees() const { return _subtrees.of_rank(_subtrees.rank()); }

  /// Leaves along the Morton curve: keys of the low corners, and levels.
  struct Leaves {
    std::vector<std::uint64_t> keys;
    std::vector<std::uint8_t> levels;

    operator CellSpans() const { return {keys, levels}; }
  };
  /// The leaves in the subtrees of this rank. Call balance() first.
  Leaves leaves() const;
  /// The leaves on all ranks. Call balance() first.
  std::int64_t leaf_count() const;

private:
  /// A cell that is to be split in the subtree of another rank.
  struct RemoteCell {
    std::uint64_t cell;
    std::int64_t owner;
  };
  /// Splits cells around `parent`, itself included. Bit i of `wanted` stands for cell i of the 27.
  void split_around(std::uint64_t parent, int level, std::uint32_t wanted);

  std::array<std::vector<std::uint64_t>, finest_level> _cells;
  std::array<std::vector<std::uint64_t>, finest_level> _above;  // cells that hold several subtrees
  std::vector<RemoteCell> _of_others;
  Subtrees _subtrees;
};

/// Finds the leaf that holds a finest cell. It is a tree with 64 branches for each node, two octree levels at
/// once.
class LeafTable {
public:
  LeafTable() = default;
  /// From all leaves of the root.
  explicit LeafTable(CellSpans leaves);
  /// Each rank gives the leaves in its own subtrees, and all leaves. Held once per compute node. Collective.
  LeafTable(const Subtrees& subtrees, CellSpans own, CellSpans all);

  /// The index of the leaf that holds the finest cell with this key.
  std::int32_t find(std::uint64_t key) const {
    std::int32_t entry = 0;
    for (int shift = top_shift;; shift -= 6) {
      entry = _entries[static_cast<std::size_t>(entry) * 64 + (key >> shift & 63)];
      if (entry >= 0) return entry;
      entry = -entry;
    }
  }

private:
  friend struct Octree;
  static constexpr int top_shift = 3 * finest_level - 6;
  parallel::NodeArray<std::int32_t> _entries;  // (nodes,64): a leaf where >= 0, else minus the node below
};

/// The leaves of an octree, the same on every rank of a communicator.
struct Octree {
  parallel::Communicator communicator;
  parallel::NodeArray<std::uint64_t> keys;   ///< Morton keys of the leaves' low corners, ascending
  parallel::NodeArray<std::uint8_t> levels;  ///< 0 is the root
  LeafTable table;

  CellSpans leaves() const { return {keys.items(), levels.items()}; }
  /// Holds the leaves and their table once on each node. Collective.
  void share();
};

/// The distinct corners of a range of leaves.
struct OctreeNodes {
  std::vector<GridPoint> points;
  std::vector<std::int32_t> corners;  ///< (leaves of the range,8) node per corner, corners in Morton order

  /// A hanging node: it lies in the middle of an edge or face of a larger leaf. The corners of that edge or
  /// face are its masters. In a balanced octree no master hangs itself.
  struct Hanging {
    std::int32_t node;
    std::int32_t count;  ///< of masters: 2 or 4
    std::array<GridPoint, 4> masters;
    std::array<std::int32_t, 4> master_nodes;  ///< -1 where that is no corner in the range
  };
  std::vector<Hanging> hanging;  ///< ascending node
};
/// Collects the corners of a range of the leaves.
OctreeNodes collect_nodes(CellSpans leaves, const LeafTable& table, IndexRange range);

/// The masters of all corners of a leaf that hang on larger leaves beside it. Some masters come more than
/// once.
std::vector<GridPoint> masters_of_corners(CellSpans leaves, const LeafTable& table, std::int32_t leaf);

}  // namespace aeroloom::sizing
