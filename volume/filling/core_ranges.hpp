/// The ranges of the Morton curve that divide the inside of the core. Each becomes a piece of the mesh.
#pragma once

#include "volume/zones/shell.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::volume {

/// Ranges of blocks with about equal numbers of core tetrahedra, counting those without shell points. The
/// same on any number of ranks.
class CoreRanges {
public:
  /// Refers to `tree` and `shell`. Collective.
  CoreRanges(const LatticeTree& tree, const Shell& shell);

  /// The range of a block of this rank; -1 if the whole mesh has no core.
  std::int32_t of(BlockIndex own) const { return _range[_core.ghosts().place(own)]; }
  /// The rank that makes the piece of a range: the lowest with blocks of it.
  parallel::Rank rank(std::int32_t range) const { return _ranks[range]; }
  /// Which points of a cell other pieces may have too, as bits. The cell has no shell point, its block is
  /// own.
  std::uint8_t shared_of(BlockIndex b, const CoreCell& cell) const;

private:
  /// Whether all leaves that touch a leaf are in its range and have no shell points.
  bool is_inner(const Leaf& leaf) const { return _inner[_core.ghosts().place(leaf.block)] >> leaf.child & 1; }
  void find_inner();
  void find_ranks();

  const LatticeTree& _tree;
  const CoreLeaves& _core;
  std::int32_t _count = 0;
  std::vector<std::int32_t> _range;         // of blocks, by place (GhostLayer)
  std::vector<std::uint8_t> _deep, _inner;  // leaves of blocks as bits, by place
  std::vector<parallel::Rank> _ranks;       // per range
};

}  // namespace aeroloom::volume
