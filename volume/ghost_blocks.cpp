#include "volume/ghost_blocks.hpp"

namespace aeroloom::volume {

GhostBlocks::GhostBlocks(const parallel::Communicator& communicator, const LatticeTree& tree,
                         std::span<const BlockIndex> shares)
    : _first(shares[communicator.rank()]), _last(shares[communicator.rank() + 1]) {
  if (communicator.size() == 1) return;
  for (BlockIndex b = _first; b < _last; ++b) {
    tree.for_each_block_in(GridBox::of(tree.cube(b)).dilated(0.5), [&](BlockIndex n) {
      if (!is_own(n)) _ghosts.push_back(n);
    });
  }
  std::sort(_ghosts.begin(), _ghosts.end());
  _ghosts.erase(std::unique(_ghosts.begin(), _ghosts.end()), _ghosts.end());
  std::vector<Wanted> asked;
  asked.reserve(_ghosts.size());
  for (const BlockIndex b : _ghosts)
    asked.push_back({b, static_cast<std::int32_t>(place(b)), communicator.rank()});
  _wanted = mesh::deliver(communicator, std::move(asked), [&](const Wanted& wanted) {
    return static_cast<parallel::Rank>(std::upper_bound(shares.begin(), shares.end() - 1, wanted.block) -
                                       shares.begin() - 1);
  });
}

}  // namespace aeroloom::volume
