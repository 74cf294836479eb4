#include "volume/lattice/ghost_layer.hpp"

#include "geometry/sort_unique.hpp"

namespace aeroloom::volume {

GhostLayer::GhostLayer(const LatticeTree& tree)
    : _communicator(tree.communicator()), _first(tree.first()), _last(tree.last()) {
  if (tree.communicator().size() == 1) return;
  for (BlockIndex b = _first; b < _last; ++b) {
    const GridBox around = GridBox::of(tree.cube(b)).dilated(0.5);
    if (tree.is_within_own(around)) continue;
    tree.for_each_block_in(around, [&](BlockIndex n) {
      if (!is_own(n)) _ghosts.push_back(n);
    });
  }
  geometry::sort_unique(_ghosts);
  std::vector<Wanted> requests;
  requests.reserve(_ghosts.size());
  for (const BlockIndex b : _ghosts)
    requests.push_back({tree.number(b), static_cast<std::int32_t>(place(b)), tree.communicator().rank()});
  _wanted = mesh::deliver(tree.communicator(), std::move(requests),
                          [&](const Wanted& wanted) { return tree.owner(wanted.block); });
  for (Wanted& wanted : _wanted) wanted.block = tree.index(wanted.block) - _first;
}

}  // namespace aeroloom::volume
