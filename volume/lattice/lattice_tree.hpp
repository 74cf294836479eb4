/// The octree of the lattice. Its leaves are grouped into blocks, from which zones and halos are made.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "sizing/field/octree.hpp"
#include "sizing/field/size_field.hpp"
#include "volume/lattice/lattice_frame.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace aeroloom::volume {

/// Trilinear interpolation of sizes may exceed the growth limit by this factor.
inline constexpr double slope_margin = std::numbers::sqrt3;

using BlockIndex = std::int32_t;   ///< of a local block on this rank, in Morton order
using BlockNumber = std::int64_t;  ///< of a block of any rank, in Morton order

/// A leaf: a block and which of its children; child 0 where the block itself is the leaf.
struct Leaf {
  BlockIndex block;
  int child;
};
/// The number of a leaf, the same on every rank: 8 times the number of its block, plus the child.
using LeafNumber = std::int64_t;

/// A block as it is sent to other ranks.
struct PackedBlock {
  BlockNumber number;
  std::uint64_t word;  ///< Morton key, level, and whether it has eight leaves

  GridCube cube() const;
};

/// A balanced octree whose leaves are as fine as the size field requires. A *block* is a cube whose eight
/// children are leaves, or a leaf with a split sibling. Blocks fill the root. Each rank owns a range of them,
/// and stores copies of some others, the *ghosts*; both are *local*. The gaps between local blocks are filled
/// with placeholder cubes, which have an index too. Asking for the data of one throws std::logic_error.
class LatticeTree {
public:
  /// Splits a cube where the mean edge of its lattice exceeds `coarsest_edge` times the size at its centre.
  /// Cubes outside `box`, in space, are not split. Blocks are assigned to ranks so that the expected work is
  /// equal: it grows with leaves and with triangles. `triangle_keys` are the Morton keys of the finest cubes
  /// that contain centres of triangles, each triangle on any one rank. Makes no ghosts. Collective.
  LatticeTree(const parallel::Communicator& communicator, const LatticeFrame& frame,
              const sizing::SizeField& field, const geometry::Box& box,
              const std::vector<std::uint64_t>& triangle_keys = {});
  static constexpr double coarsest_edge = 1.53;

  const parallel::Communicator& communicator() const { return _communicator; }
  /// The number of indices: local blocks and placeholders.
  BlockIndex block_count() const { return static_cast<BlockIndex>(_blocks.keys.size()); }
  /// The blocks of this rank have the indices from first() to before last().
  BlockIndex first() const { return _first; }
  BlockIndex last() const { return _last; }
  bool is_own(BlockIndex b) const { return b >= _first && b < _last; }
  bool is_local(BlockIndex b) const { return _numbers.empty() || _numbers[b] >= 0; }

  /// The number of blocks of all ranks.
  BlockNumber total() const { return _firsts.back(); }
  BlockNumber number(BlockIndex b) const { return _numbers.empty() ? b : _numbers[b]; }
  LeafNumber number(const Leaf& leaf) const { return 8 * number(leaf.block) + leaf.child; }
  bool has(BlockNumber number) const { return find(number) >= 0; }
  /// The index of a local block.
  BlockIndex index(BlockNumber number) const { return required(find(number)); }
  Leaf leaf_of(LeafNumber number) const { return {index(number / 8), static_cast<int>(number % 8)}; }
  /// The rank that owns a block.
  parallel::Rank owner(BlockNumber number) const {
    return static_cast<parallel::Rank>(std::upper_bound(_firsts.begin(), _firsts.end(), number) -
                                       _firsts.begin() - 1);
  }
  /// Calls visit(rank) for the ranks that own blocks which touch the box; for some more than once.
  template <class Visit>
  void for_each_rank_in(const GridBox& box, const Visit& visit) const {
    ranks_below(box, {{0, 0, 0}, 0}, visit);
  }
  PackedBlock packed(BlockIndex b) const;
  /// Adds ghosts. This changes the indices of blocks.
  void add(std::vector<PackedBlock> blocks);

  GridCube cube(BlockIndex b) const { return {sizing::grid_point(_blocks.keys[b]), _blocks.levels[b]}; }
  int level(BlockIndex b) const { return _blocks.levels[b]; }
  int leaf_count(BlockIndex b) const { return _split[b] ? 8 : 1; }
  int leaf_level(BlockIndex b) const { return _blocks.levels[b] + _split[b]; }
  GridCube leaf(BlockIndex b, int child) const;
  GridCube leaf(const Leaf& which) const { return leaf(which.block, which.child); }
  /// All leaves of a block, as bits.
  std::uint8_t all_leaves(BlockIndex b) const { return _split[b] ? 0xff : 1; }

  BlockIndex block_at(sizing::GridPoint p) const { return required(any_at(p)); }
  /// The block that contains a finest cube, or the placeholder that does.
  BlockIndex any_at(sizing::GridPoint p) const { return _table.find(sizing::morton_key(p)); }
  /// Which leaf of a block contains a finest cube.
  int child_at(BlockIndex b, sizing::GridPoint p) const {
    if (!_split[b]) return 0;
    const int shift = sizing::finest_level - 1 - _blocks.levels[b];
    return static_cast<int>((p.x >> shift & 1) | (p.y >> shift & 1) << 1 | (p.z >> shift & 1) << 2);
  }
  /// The leaf that contains a finest cube.
  Leaf leaf_at(sizing::GridPoint p) const {
    const BlockIndex b = block_at(p);
    return {b, child_at(b, p)};
  }
  /// Whether a cube that touches a block of this rank is split. True if its low corner is not local.
  bool is_split(const GridCube& cube) const;

  /// The smallest cube that contains the part of a box inside the root.
  static GridCube smallest_cube(const GridBox& box) {
    const std::uint64_t low = sizing::morton_key(nearest_cube(box.low));
    const std::uint64_t high = sizing::morton_key(nearest_cube(box.high));
    const int shift = ((low == high ? 0 : 64 - __builtin_clzll(low ^ high)) + 2) / 3 * 3;
    return {sizing::grid_point(low >> shift << shift), sizing::finest_level - shift / 3};
  }
  /// The lowest and the highest index of blocks that touch the box. They are at its low and its high corner,
  /// because Morton order ascends along every axis.
  std::pair<BlockIndex, BlockIndex> range_of(const GridBox& box) const {
    return {any_at(nearest_cube(box.low)), any_at(nearest_cube(box.high))};
  }
  /// Whether this rank owns all blocks that touch the box.
  bool is_within_own(const GridBox& box) const {
    const auto [lowest, highest] = range_of(box);
    return is_own(lowest) && is_own(highest);
  }
  /// Calls visit(b) for all blocks that touch the box, in ascending order. All must be local.
  template <class Visit>
  void for_each_block_in(const GridBox& box, const Visit& visit) const {
    any_block_in(box, [&](BlockIndex b) {
      visit(b);
      return false;
    });
  }
  /// The same for the blocks of this rank alone.
  template <class Visit>
  void for_each_own_block_in(const GridBox& box, const Visit& visit) const {
    any_own_block_in(box, [&](BlockIndex b) {
      visit(b);
      return false;
    });
  }
  /// Whether holds(b) is true for a block of this rank that touches the box. Stops at the first one.
  template <class Holds>
  bool any_own_block_in(const GridBox& box, const Holds& holds) const {
    return any_block_in(box, holds, [this](BlockIndex first, BlockIndex last, const GridCube&) {
      return last <= _first || first >= _last;
    });
  }
  /// Whether holds(b) is true for a block that touches the box. Stops at the first one.
  template <class Holds>
  bool any_block_in(const GridBox& box, const Holds& holds) const {
    return any_block_in(box, holds, [](BlockIndex, BlockIndex, const GridCube&) { return false; });
  }
  /// The same, but leaves out the blocks from `first` to before `last`, which fill `cube`, where
  /// skips(first, last, cube) is true.
  template <class Holds, class Skips>
  bool any_block_in(const GridBox& box, const Holds& holds, const Skips& skips) const;

private:
  /// The finest cube that contains a place in the grid; for places outside, the nearest one.
  static sizing::GridPoint nearest_cube(geometry::Vec3 place) {
    const auto clamp = [](double t) {
      return static_cast<std::uint32_t>(std::clamp(t, 0.0, sizing::grid_size - 1.0));
    };
    return {clamp(place.x), clamp(place.y), clamp(place.z)};
  }
  /// A cube, and the blocks from `first` to before `last` that fill it.
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
  /// Sets the local blocks. This rank owns `own` of them, numbered from `first` on.
  void fill(const std::vector<PackedBlock>& blocks, BlockNumber first, BlockIndex own);

  parallel::Communicator _communicator;
  std::vector<BlockNumber> _firsts;  // per rank, and the end
  std::vector<std::uint64_t> _keys;  // per rank: of its first block; without blocks: as the next rank's
  BlockIndex _first = 0, _last = 0;
  sizing::SplitCubes::Leaves _blocks;
  std::vector<std::uint8_t> _split;
  std::vector<BlockNumber> _numbers;  // -1: placeholder; empty where all blocks are local
  std::vector<BlockIndex> _local;     // indices of local blocks; empty as well
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
