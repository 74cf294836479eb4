/// The octree of the lattice, and its blocks: the unit of which zones and halos are made.
#pragma once

#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/octree.hpp"
#include "sizing/size_field.hpp"
#include "volume/lattice_frame.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <vector>

namespace aeroloom::volume {

/// Trilinear interpolation may be steeper than the growth limit by this factor.
inline constexpr double slope_margin = std::numbers::sqrt3;

using BlockIndex = std::int32_t;  ///< of a block, along the Morton curve

/// A leaf: a child of a block, 0 where the block is the leaf.
struct Leaf {
  BlockIndex block;
  int child;
};
/// Leaves in one number, by block, then child.
using LeafNumber = std::int64_t;
inline LeafNumber leaf_number(const Leaf& leaf) {
  return 8 * LeafNumber{leaf.block} + leaf.child;
}
inline Leaf leaf_of_number(LeafNumber number) {
  return {static_cast<BlockIndex>(number / 8), static_cast<int>(number % 8)};
}

/// An octree whose leaves are as fine as the sizes ask for and whose neighbours, over faces, edges and
/// corners, differ by one level at most. A *block* is a cube with eight leaves, or a leaf that has a split
/// sibling. Blocks fill the root. Immutable, the same on every rank: one key and one level per block.
class LatticeTree {
public:
  /// A cube is split where the mean edge of its lattice is above `coarsest_edge` times the size at its
  /// centre. Cubes off `box`, in space, are not split. Ranks share the work but for the tables. Collective.
  LatticeTree(const parallel::Communicator& communicator, const LatticeFrame& frame,
              const sizing::SizeField& field, const geometry::Box& box, parallel::StageClock& clock);
  static constexpr double coarsest_edge = 1.53;

  BlockIndex block_count() const { return static_cast<BlockIndex>(_blocks.keys.size()); }
  GridCube cube(BlockIndex b) const { return {sizing::grid_point(_blocks.keys[b]), _blocks.levels[b]}; }
  int level(BlockIndex b) const { return _blocks.levels[b]; }
  int leaf_count(BlockIndex b) const { return _split[b] ? 8 : 1; }
  int leaf_level(BlockIndex b) const { return _blocks.levels[b] + _split[b]; }
  GridCube leaf(BlockIndex b, int child) const;
  GridCube leaf(const Leaf& which) const { return leaf(which.block, which.child); }
  /// All leaves of a block, a bit each.
  std::uint8_t all_leaves(BlockIndex b) const { return _split[b] ? 0xff : 1; }

  BlockIndex block_at(sizing::GridPoint p) const { return _table.find(sizing::morton_key(p)); }
  /// Which leaf of its block holds a finest cube.
  int child_at(BlockIndex b, sizing::GridPoint p) const {
    if (!_split[b]) return 0;
    const int shift = sizing::finest_level - 1 - _blocks.levels[b];
    return static_cast<int>((p.x >> shift & 1) | (p.y >> shift & 1) << 1 | (p.z >> shift & 1) << 2);
  }
  /// Whether a cube has children.
  bool is_split(const GridCube& cube) const;

  /// The lowest and the highest of the blocks that touch the box: those at its low and its high corner, since
  /// Morton order ascends along every axis.
  std::pair<BlockIndex, BlockIndex> range_of(const GridBox& box) const {
    return {block_at(nearest_cube(box.low)), block_at(nearest_cube(box.high))};
  }
  /// Calls visit(b) for all blocks that touch the box, ascending.
  template <class Visit>
  void for_each_block_in(const GridBox& box, const Visit& visit) const {
    any_block_in(box, [&](BlockIndex b) {
      visit(b);
      return false;
    });
  }
  /// Whether holds(b) for a block that touches the box; it is not asked any further then.
  template <class Holds>
  bool any_block_in(const GridBox& box, const Holds& holds) const {
    return any_block_in(box, holds, [](BlockIndex, BlockIndex, const GridCube&) { return false; });
  }
  /// As before; of the blocks from `first` to before `last`, which fill `cube`, none is asked where
  /// skips(first, last, cube).
  template <class Holds, class Skips>
  bool any_block_in(const GridBox& box, const Holds& holds, const Skips& skips) const;

private:
  /// The finest cube that holds a place in the grid; the nearest one for places outside.
  static sizing::GridPoint nearest_cube(geometry::Vec3 place) {
    const auto clamp = [](double t) {
      return static_cast<std::uint32_t>(std::clamp(t, 0.0, sizing::grid_size - 1.0));
    };
    return {clamp(place.x), clamp(place.y), clamp(place.z)};
  }
  template <class Holds, class Skips>
  bool any_below(const GridBox& box, std::uint64_t key, int level, BlockIndex first, BlockIndex last,
                 const Holds& holds, const Skips& skips) const;

  sizing::SplitCubes::Leaves _blocks;
  std::vector<std::uint8_t> _split;
  sizing::LeafTable _table;
};

template <class Holds, class Skips>
bool LatticeTree::any_block_in(const GridBox& box, const Holds& holds, const Skips& skips) const {
  const std::uint64_t low = sizing::morton_key(nearest_cube(box.low));
  const std::uint64_t high = sizing::morton_key(nearest_cube(box.high));
  // The smallest cube that holds both corners.
  const int differing = low == high ? 0 : 64 - __builtin_clzll(low ^ high);
  const int shift = (differing + 2) / 3 * 3;
  const std::uint64_t key = low >> shift << shift;
  const BlockIndex first = _table.find(key), end = block_count();
  const std::uint64_t next = key + (1ULL << shift);
  const BlockIndex last = next >> 3 * sizing::finest_level != 0 ? end : _table.find(next);
  if (last <= first) return !skips(first, first + 1, cube(first)) && holds(first);
  return any_below(box, key, sizing::finest_level - shift / 3, first, last, holds, skips);
}

template <class Holds, class Skips>
bool LatticeTree::any_below(const GridBox& box, std::uint64_t key, int level, BlockIndex first,
                            BlockIndex last, const Holds& holds, const Skips& skips) const {
  const GridCube here{sizing::grid_point(key), level};
  if (skips(first, last, here)) return false;
  if (last - first == 1) return GridBox::of(cube(first)).overlaps(box) && holds(first);
  const GridBox whole = GridBox::of(here);
  if (!whole.overlaps(box)) return false;
  // Which halves the box touches, along each axis: looking up where children begin is what costs.
  const geometry::Vec3 middle = 0.5 * (whole.low + whole.high);
  std::array<std::array<bool, 2>, 3> touched;
  for (int axis = 0; axis < 3; ++axis)
    touched[axis] = {box.low[axis] <= middle[axis], box.high[axis] >= middle[axis]};
  const int shift = 3 * (sizing::finest_level - level - 1);
  std::uint64_t found = 0;  // the child that begins at `first`
  for (std::uint64_t child = 0; child < 8; ++child) {
    if (!touched[0][child & 1] || !touched[1][child >> 1 & 1] || !touched[2][child >> 2]) continue;
    if (child != found) first = _table.find(key + (child << shift));
    const BlockIndex end = child == 7 ? last : _table.find(key + ((child + 1) << shift));
    if (any_below(box, key + (child << shift), level + 1, first, end, holds, skips)) return true;
    first = end;
    found = child + 1;
  }
  return false;
}

}  // namespace aeroloom::volume
