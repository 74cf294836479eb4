/// The octree of the lattice, and its blocks: the unit of which zones and halos are made.
#pragma once

#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/octree.hpp"
#include "sizing/size_field.hpp"
#include "volume/lattice_frame.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace aeroloom::volume {

using BlockIndex = std::int32_t;  ///< of a block, along the Morton curve

/// An octree whose leaves are as fine as the sizes ask for and whose neighbours, over faces, edges and corners,
/// differ by one level at most. A *block* is a cell with eight leaves, or a leaf that has a split sibling.
/// Blocks fill the root. Immutable, the same on every rank: one key and one level per block.
class LatticeTree {
public:
  /// A cell is split where the mean edge of its lattice is above `coarsest_edge` times the size at its centre.
  /// Cells off `box` are not split. Ranks share the asking for sizes. Collective.
  LatticeTree(const parallel::Communicator& communicator, const LatticeFrame& frame,
              const sizing::SizeField& field, const GridBox& box, parallel::StageClock& clock);
  static constexpr double coarsest_edge = 1.6;

  BlockIndex block_count() const { return static_cast<BlockIndex>(_blocks.keys.size()); }
  GridCell cell(BlockIndex b) const { return {sizing::grid_point(_blocks.keys[b]), _blocks.levels[b]}; }
  int leaf_count(BlockIndex b) const { return _split[b] ? 8 : 1; }
  int leaf_level(BlockIndex b) const { return _blocks.levels[b] + _split[b]; }
  GridCell leaf(BlockIndex b, int child) const;
  /// All leaves of a block, a bit each.
  std::uint8_t all_leaves(BlockIndex b) const { return _split[b] ? 0xff : 1; }

  BlockIndex block_at(sizing::GridPoint p) const { return _table.find(sizing::morton_key(p)); }
  /// Which leaf of its block holds a finest cell.
  int child_at(BlockIndex b, sizing::GridPoint p) const;
  /// Whether a cell has children.
  bool is_split(const GridCell& cell) const;

  /// Calls visit(b) for all blocks that touch the box, ascending.
  template <class Visit>
  void for_each_block_in(const GridBox& box, const Visit& visit) const;

private:
  template <class Visit>
  void descend(const GridBox& box, std::uint64_t key, int level, BlockIndex first, BlockIndex last,
               const Visit& visit) const;

  sizing::SplitCells::Leaves _blocks;
  std::vector<std::uint8_t> _split;
  sizing::LeafTable _table;
};

template <class Visit>
void LatticeTree::for_each_block_in(const GridBox& box, const Visit& visit) const {
  const auto clamp = [](double t) {
    return static_cast<std::uint32_t>(std::clamp(t, 0.0, sizing::grid_size - 1.0));
  };
  const std::uint64_t low = sizing::morton_key({clamp(box.low.x), clamp(box.low.y), clamp(box.low.z)});
  const std::uint64_t high = sizing::morton_key({clamp(box.high.x), clamp(box.high.y), clamp(box.high.z)});
  int level = sizing::finest_level;
  while (level > 0 && low >> 3 * (sizing::finest_level - level) != high >> 3 * (sizing::finest_level - level)) --level;
  const int shift = 3 * (sizing::finest_level - level);
  const std::uint64_t key = low >> shift << shift;
  const auto& keys = _blocks.keys;
  const auto first = std::upper_bound(keys.begin(), keys.end(), key) - keys.begin() - 1;
  const auto last = shift >= 60 ? keys.end() : std::lower_bound(keys.begin() + first, keys.end(), key + (1ULL << shift));
  descend(box, key, level, static_cast<BlockIndex>(first), static_cast<BlockIndex>(last - keys.begin()), visit);
}

template <class Visit>
void LatticeTree::descend(const GridBox& box, std::uint64_t key, int level, BlockIndex first, BlockIndex last,
                          const Visit& visit) const {
  if (last - first == 1) {
    if (GridBox::of(cell(first)).overlaps(box)) visit(first);
    return;
  }
  if (!GridBox::of({sizing::grid_point(key), level}).overlaps(box)) return;
  const int shift = 3 * (sizing::finest_level - level - 1);
  const auto begin = _blocks.keys.begin();
  for (std::uint64_t child = 0; child < 8; ++child) {
    const std::uint64_t next = key + ((child + 1) << shift);
    const auto end = child == 7 ? last : static_cast<BlockIndex>(std::lower_bound(begin + first, begin + last, next) - begin);
    if (end > first) descend(box, key + (child << shift), level + 1, first, end, visit);
    first = end;
  }
}

}  // namespace aeroloom::volume
