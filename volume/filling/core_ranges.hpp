/// Ranges of the curve that the inside of the core is divided into: a piece of the mesh each.
#pragma once

#include "volume/zones/shell.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::volume {

/// Blocks in ranges of about equal numbers of cells that have no point of the shell; a function of these
/// alone, and the same on any number of ranks.
class CoreRanges {
public:
  /// Refers to `tree` and `shell`. Collective.
  CoreRanges(const LatticeTree& tree, const Shell& shell);

  /// The range of one of this rank's blocks; -1 where there is no core at all.
  std::int32_t of(BlockIndex own) const { return _range[_core.ghosts().place(own)]; }
  /// Which rank makes a range a piece: the lowest that has some of it.
  parallel::Rank rank(std::int32_t range) const { return _ranks[range]; }
  /// The points of a cell of an own block, without points of the shell, that cells of other pieces may have.
  std::uint8_t shared_of(BlockIndex b, const CoreCell& cell) const;

private:
  /// All leaves that touch it are of its range, and none of them has points of the shell.
  bool is_inner(const Leaf& leaf) const { return _inner[_core.ghosts().place(leaf.block)] >> leaf.child & 1; }
  void find_inner();
  void find_ranks();

  const LatticeTree& _tree;
  const CoreLeaves& _core;
  std::int32_t _count = 0;
  std::vector<std::int32_t> _range;         // of blocks, by place
  std::vector<std::uint8_t> _deep, _inner;  // leaves of blocks, by place
  std::vector<parallel::Rank> _ranks;       // per range
};

}  // namespace aeroloom::volume
