/// The octree behind the size field: which cells are split, the leaves along the curve, and how a point finds
/// its leaf.
#pragma once

#include "parallel/communication/node_array.hpp"
#include "sizing/field/pages.hpp"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// An octree as the sets of its split cells, one ascending list of level keys per level (a level key has
/// three bits per level). Splitting a cell splits its ancestors once balance() has run. Each rank has the
/// cells in its own pages; those that hold several pages are all split.
class SplitCubes {
public:
  /// On this rank alone.
  SplitCubes() = default;
  explicit SplitCubes(Pages pages);

  /// Splits the cell of `level` that holds the finest cell `key`, in a page of this rank.
  void split(std::uint64_t key, int level) {
    if (level >= _pages.level(_pages.find(key))) _cells[level].push_back(key >> 3 * (finest_level - level));
  }
  /// Splits what it takes to have leaves of at most one level apart across faces, edges and corners.
  /// Collective, as leaf_count().
  void balance();

  const Pages& pages() const { return _pages; }
  /// The pages of this rank.
  IndexRange own_pages() const { return _pages.of_rank(_pages.rank()); }

  /// Leaves along the Morton curve: key of the low corner, level.
  struct Leaves {
    std::vector<std::uint64_t> keys;
    std::vector<std::uint8_t> levels;

    operator CellSpans() const { return {keys, levels}; }
  };
  /// The leaves in this rank's pages. After balance().
  Leaves leaves() const;
  /// How many there are on all ranks, once balanced.
  std::int64_t leaf_count() const;

private:
  /// A cell of a level to be split in another rank's page.
  struct Request {
    std::uint64_t cell;
    std::int64_t owner;

    static constexpr auto fields() { return std::tuple(&Request::cell, &Request::owner); }
  };
  /// Splits cells of a level around one of them, that included, by their places among the 27.
  void split_around(std::uint64_t parent, int level, std::uint32_t wanted);

  std::array<std::vector<std::uint64_t>, finest_level> _cells;
  std::array<std::vector<std::uint64_t>, finest_level> _above;  // cells that hold several pages
  std::vector<Request> _of_others;
  Pages _pages;
};

/// Finds the leaf of a finest cell: a tree with 64 branches per node, two octree levels each.
class LeafTable {
public:
  LeafTable() = default;
  /// Of all leaves of the root.
  explicit LeafTable(CellSpans leaves);
  /// Each rank gives the leaves in its pages, and knows all; held once per node. Collective.
  LeafTable(const Pages& pages, CellSpans own, CellSpans all);

  /// Index of the leaf that holds the finest cell with this key.
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
  /// From here on held once per node. Collective.
  void share();
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
/// Of a range of all leaves.
OctreeNodes collect_nodes(CellSpans leaves, const LeafTable& table, IndexRange range);

/// The corners of a leaf that hang on larger leaves beside it: their masters, some more than once.
std::vector<GridPoint> masters_of_corners(CellSpans leaves, const LeafTable& table, std::int32_t leaf);

}  // namespace aeroloom::sizing
