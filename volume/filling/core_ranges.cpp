#include "volume/filling/core_ranges.hpp"

#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace aeroloom::volume {

CoreRanges::CoreRanges(const LatticeTree& tree, const Shell& shell)
    : _tree(tree), _core(shell.local.core), _range(_core.ghosts().count(), -1), _deep(shell.local.deep) {
  const GhostLayer& ghosts = _core.ghosts();
  const std::vector<std::uint16_t>& weights = shell.local.inner_cells;
  const std::int64_t mine = std::accumulate(weights.begin(), weights.end(), std::int64_t{0});
  const std::vector<std::int64_t> all = tree.communicator().all_gather_items<std::int64_t>(std::array{mine});
  const std::int64_t total = std::accumulate(all.begin(), all.end(), std::int64_t{0});
  std::int64_t before =
      std::accumulate(all.begin(), all.begin() + tree.communicator().rank(), std::int64_t{0});
  _count = wanted_zones(static_cast<double>(total), shell.core_piece_tets);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (total > 0) _range[i] = static_cast<std::int32_t>(std::min(before, total - 1) * _count / total);
    before += weights[i];
  }
  _deep.resize(ghosts.count(), 0);
  ghosts.update(_range);
  ghosts.update(_deep);
  _inner.assign(ghosts.count(), 0);
  {
    const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
    find_inner();
  }
  ghosts.update(_inner);
  find_ranks();
}

std::uint8_t CoreRanges::shared_of(BlockIndex b, const CoreCell& cell) const {
  constexpr int center_slot = 7;
  if (!is_inner({b, cell.child})) return 0xf;
  std::uint8_t shared = 0;
  for (int k = 0; k < 4; ++k) {
    if (cell.points[k] % slots_per_leaf == center_slot && !is_inner(leaf_of_lattice(_tree, cell.points[k])))
      shared |= static_cast<std::uint8_t>(1U << k);
  }
  return shared;
}

void CoreRanges::find_inner() {
  const GhostLayer& ghosts = _core.ghosts();
  LeafSurroundings around(_tree);
  for (std::size_t i = 0; i < ghosts.own_count(); ++i) {
    if (_deep[i] == 0) continue;
    around.move_to(ghosts.first() + static_cast<BlockIndex>(i));
    const auto is_elsewhere = [&](const Leaf& leaf) {
      const std::size_t place = ghosts.place(leaf.block);
      return _range[place] != _range[i] || !(_deep[place] >> leaf.child & 1);
    };
    for (int child = 0; child < 8; ++child) {
      if ((_deep[i] >> child & 1) && around.all_points_of(around.place_of(child), [&](const HalfPlace& at) {
            return !around.any_leaf_at(at, is_elsewhere);
          }))
        _inner[i] |= static_cast<std::uint8_t>(1U << child);
    }
  }
}

void CoreRanges::find_ranks() {
  const parallel::Communicator& communicator = _tree.communicator();
  struct RangeRank {
    std::int32_t range;
    parallel::Rank rank;
  };
  std::vector<RangeRank> rows;
  for (std::size_t i = 0; i < _core.ghosts().own_count(); ++i) {
    if (_range[i] >= 0 && (rows.empty() || rows.back().range != _range[i]))
      rows.push_back({_range[i], communicator.rank()});
  }
  _ranks.assign(_count, communicator.size());
  for (const RangeRank& row : communicator.all_gather_items<RangeRank>(rows))
    _ranks[row.range] = std::min(_ranks[row.range], row.rank);
}

}  // namespace aeroloom::volume
