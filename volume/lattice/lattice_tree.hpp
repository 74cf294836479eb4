/// The octree of the lattice, and its blocks: the unit of which zones and halos are made.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "sizing/field/octree.hpp"
#include "sizing/field/size_field.hpp"
#include "volume/lattice/lattice_frame.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

namespace aeroloom::volume {

/// Trilinear interpolation may be steeper than the growth limit by this factor.
inline constexpr double slope_margin = std::numbers::sqrt3;

using BlockIndex = std::int32_t;   ///< of a block, along the Morton curve, on this rank
using BlockNumber = std::int64_t;  ///< of a block, along the Morton curve of the whole root

/// A leaf: a child of a block, 0 where the block is the leaf.
struct Leaf {
  BlockIndex block;
  int child;
};
/// Leaves in one number, the same on every rank: by number of the block, then child.
using LeafNumber = std::int64_t;

/// What travels of a block.
struct PackedBlock {
  BlockNumber number;
  std::uint64_t word;  ///< key, level, and whether it has eight leaves

  GridCube cube() const;
  static constexpr auto fields() { return std::tuple(&PackedBlock::number, &PackedBlock::word); }
};

/// An octree whose leaves are as fine as the sizes ask for and whose neighbours, over faces, edges and
/// corners, differ by one level at most. A *block* is a cube with eight leaves, or a leaf that has a split
/// sibling. Blocks fill the root; each rank owns a range of them. *Local* are these and ghosts, blocks of
/// other ranks. In between there are cubes of which nothing is known, with a place among the blocks: to ask
/// for one is an error.
class LatticeTree {
public:
  /// A cube is split where the mean edge of its lattice is above `coarsest_edge` times the size at its
  /// centre. Cubes off `box`, in space, are not split. Ranks get equal shares of expected work: what leaves
  /// and the triangles cost whose centres lie in finest cubes with the keys given, on any rank. There are no
  /// ghosts so far. Collective.
  LatticeTree(const parallel::Communicator& communicator, const LatticeFrame& frame,
              const sizing::SizeField& field, const geometry::Box& box,
              const std::vector<std::uint64_t>& triangle_keys = {});
  static constexpr double coarsest_edge = 1.53;

  const parallel::Communicator& communicator() const { return _communicator; }
  /// With the cubes in between.
  BlockIndex block_count() const { return static_cast<BlockIndex>(_blocks.keys.size()); }
  /// This rank's: from first() to before last().
  BlockIndex first() const { return _first; }
  BlockIndex last() const { return _last; }
  bool is_own(BlockIndex b) const { return b >= _first && b < _last; }
  bool is_local(BlockIndex b) const { return _numbers.empty() || _numbers[b] >= 0; }

  /// Of all ranks.
  BlockNumber total() const { return _firsts.back(); }
  BlockNumber number(BlockIndex b) const { return _numbers.empty() ? b : _numbers[b]; }
  LeafNumber number(const Leaf& leaf) const { return 8 * number(leaf.block) + leaf.child; }
  bool has(BlockNumber number) const { return find(number) >= 0; }
  /// Of a local block.
  BlockIndex index(BlockNumber number) const { return required(find(number)); }
  Leaf leaf_of(LeafNumber number) const { return {index(number / 8), static_cast<int>(number % 8)}; }
  /// The rank that has a block.
  parallel::Rank owner(BlockNumber number) const {
    return static_cast<parallel::Rank>(std::upper_bound(_firsts.begin(), _firsts.end(), number) -
                                       _firsts.begin() - 1);
  }
  /// Calls visit(rank) for those that have blocks which touch the box; for some more than once.
  template <class Visit>
  void for_each_rank_in(const GridBox& box, const Visit& visit) const {
    ranks_below(box, {{0, 0, 0}, 0}, visit);
  }
  PackedBlock packed(BlockIndex b) const;
  /// Adds ghosts. Indices of blocks change: this comes before anything is kept by them.
  void add(std::vector<PackedBlock> blocks);

  GridCube cube(BlockIndex b) const { return {sizing::grid_point(_blocks.keys[b]), _blocks.levels[b]}; }
  int level(BlockIndex b) const { return _blocks.levels[b]; }
  int leaf_count(BlockIndex b) const { return _split[b] ? 8 : 1; }
  int leaf_level(BlockIndex b) const { return _blocks.levels[b] + _split[b]; }
  GridCube leaf(BlockIndex b, int child) const;
  GridCube leaf(const Leaf& which) const { return leaf(which.block, which.child); }
  /// All leaves of a block, a bit each.
  std::uint8_t all_leaves(BlockIndex b) const { return _split[b] ? 0xff : 1; }

  BlockIndex block_at(sizing::GridPoint p) const { return required(any_at(p)); }
  /// The block at a place, or a cube of which nothing is known.
  BlockIndex any_at(sizing::GridPoint p) const { return _table.find(sizing::morton_key(p)); }
  /// Which leaf of its block holds a finest cube.
  int child_at(BlockIndex b, sizing::GridPoint p) const {
    if (!_split[b]) return 0;
    const int shift = sizing::finest_level - 1 - _blocks.levels[b];
    return static_cast<int>((p.x >> shift & 1) | (p.y >> shift & 1) << 1 | (p.z >> shift & 1) << 2);
  }
  /// Whether a cube that touches a block of this rank has children. Where its low corner is not local it
  /// does.
  bool is_split(const GridCube& cube) const;

  /// The smallest cube that holds all of a box that is in the root.
  static GridCube smallest_cube(const GridBox& box) {
    const std::uint64_t low = sizing::morton_key(nearest_cube(box.low));
    const std::uint64_t high = sizing::morton_key(nearest_cube(box.high));
    const int shift = ((low == high ? 0 : 64 - __builtin_clzll(low ^ high)) + 2) / 3 * 3;
    return {sizing::grid_point(low >> shift << shift), sizing::finest_level - shift / 3};
  }
  /// The lowest and the highest of the blocks that touch the box: those at its low and its high corner, since
  /// Morton order ascends along every axis.
  std::pair<BlockIndex, BlockIndex> range_of(const GridBox& box) const {
    return {any_at(nearest_cube(box.low)), any_at(nearest_cube(box.high))};
  }
  /// Whether all blocks that touch the box are this rank's.
  bool is_within_own(const GridBox& box) const {
    const auto [lowest, highest] = range_of(box);
    return is_own(lowest) && is_own(highest);
  }
  /// Calls visit(b) for all blocks that touch the box, ascending.
  template <class Visit>
  void for_each_block_in(const GridBox& box, const Visit& visit) const {
    any_block_in(box, [&](BlockIndex b) {
      visit(b);
      return false;
    });
  }
  /// Of this rank's.
  template <class Visit>
  void for_each_own_block_in(const GridBox& box, const Visit& visit) const {
    any_own_block_in(box, [&](BlockIndex b) {
      visit(b);
      return false;
    });
  }
  /// Whether holds(b) for one of this rank's that touches the box; it is not asked any further then.
  template <class Holds>
  bool any_own_block_in(const GridBox& box, const Holds& holds) const {
    return any_block_in(box, holds, [this](BlockIndex first, BlockIndex last, const GridCube&) {
      return last <= _first || first >= _last;
    });
  }
  /// Whether holds(b) for a block that touches the box; it is not asked any further then.
  template <class Holds>
  bool any_block_in(const GridBox& box, const Holds& holds) const {
    return any_block_in(box, holds, [](BlockIndex, BlockIndex, const GridCube&) { return false; });
  }
  /// Whether holds(b) for a block that touches the box; of the blocks from `first` to before `last`, which
  /// fill `cube`, none is asked where skips(first, last, cube).
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
  /// A cube by its Morton key and level, and the blocks that fill it: from `first` to before `last`.
  struct Subtree {
    std::uint64_t key;
    int level;
    BlockIndex first, last;
  };
  template <class Holds, class Skips>
  bool any_below(const GridBox& box, const Subtree& tree, const Holds& holds, const Skips& skips) const;

  BlockIndex required(BlockIndex b) const {
    if (b < 0 || !is_local(b)) throw_not_local();
    return b;
  }
  [[noreturn]] static void throw_not_local();
  BlockIndex find(BlockNumber number) const;
  template <class Visit>
  void ranks_below(const GridBox& box, const GridCube& cube, const Visit& visit) const;
  parallel::Rank owner_of_key(std::uint64_t key) const {
    return static_cast<parallel::Rank>(std::upper_bound(_keys.begin(), _keys.end(), key) - _keys.begin() - 1);
  }
  /// Of this rank are `own` blocks, numbered from `first` on.
  void fill(const std::vector<PackedBlock>& blocks, BlockNumber first, BlockIndex own);

  parallel::Communicator _communicator;
  std::vector<BlockNumber> _firsts;  // per rank, and the end
  std::vector<std::uint64_t> _keys;  // per rank: where its blocks begin, those of one without any the next's
  BlockIndex _first = 0, _last = 0;
  sizing::SplitCubes::Leaves _blocks;
  std::vector<std::uint8_t> _split;
  std::vector<BlockNumber> _numbers;  // -1: not local; none where all blocks are
  std::vector<BlockIndex> _local;     // blocks that are, ascending, where not all are
  sizing::LeafTable _table;
};

template <class Holds, class Skips>
bool LatticeTree::any_block_in(const GridBox& box, const Holds& holds, const Skips& skips) const {
  const GridCube around = smallest_cube(box);
  const std::uint64_t key = around.key();
  const BlockIndex first = _table.find(key), end = block_count();
  const std::uint64_t next = key + (1ULL << 3 * (sizing::finest_level - around.level));
  const BlockIndex last = next >> 3 * sizing::finest_level != 0 ? end : _table.find(next);
  if (last <= first) return !skips(first, first + 1, cube(first)) && holds(required(first));
  return any_below(box, {key, around.level, first, last}, holds, skips);
}

template <class Holds, class Skips>
bool LatticeTree::any_below(const GridBox& box, const Subtree& tree, const Holds& holds,
                            const Skips& skips) const {
  const auto [key, level, begin, last] = tree;
  BlockIndex first = begin;  // where the next child begins
  const GridCube here{sizing::grid_point(key), level};
  if (skips(first, last, here)) return false;
  if (last - first == 1) return GridBox::of(cube(first)).overlaps(box) && holds(required(first));
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
    if (any_below(box, {key + (child << shift), level + 1, first, end}, holds, skips)) return true;
    first = end;
    found = child + 1;
  }
  return false;
}

template <class Visit>
void LatticeTree::ranks_below(const GridBox& box, const GridCube& cube, const Visit& visit) const {
  if (!GridBox::of(cube).overlaps(box)) return;
  const std::uint64_t key = cube.key(), size = 1ULL << 3 * (sizing::finest_level - cube.level);
  const parallel::Rank lowest = owner_of_key(key);
  if (lowest == owner_of_key(key + size - 1)) return visit(lowest);
  for (int c = 0; c < 8; ++c) ranks_below(box, cube.child(c), visit);
}

}  // namespace aeroloom::volume
