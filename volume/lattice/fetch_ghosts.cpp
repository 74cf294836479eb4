#include "volume/lattice/fetch_ghosts.hpp"

#include "geometry/sort_unique.hpp"
#include "parallel/observation/timers.hpp"
#include "volume/lattice/block_points.hpp"
#include "volume/lattice/fetch_blocks.hpp"

namespace aeroloom::volume {

using parallel::ScopedCpu;

void BlockQueries::add(const GridBox& where, BlockQuery query) {
  if (_tree.is_within_own(where)) return;
  query.from = _tree.communicator().rank();
  std::vector<parallel::Rank> ranks;
  _tree.for_each_rank_in(where, [&](parallel::Rank rank) { ranks.push_back(rank); });
  geometry::sort_unique(ranks);
  for (const parallel::Rank rank : ranks) {
    query.to = rank;
    if (rank != query.from) _queries.push_back(query);
  }
}

std::vector<GhostBlock> fetch_ghosts(const Lattice& lattice) {
  const LatticeTree& tree = lattice.tree;
  if (tree.communicator().size() == 1) return {};
  const ScopedCpu task(ScopedCpu::As::task);
  BlockQueries queries(tree);
  const auto add_query = [&](const GridBox& box) { queries.add(box, {.box = box}); };
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) add_query(GridBox::of(tree.cube(b)).dilated(0.5));
  for (const SurfaceTriangle& triangle : lattice.triangles) {
    for (const geometry::Vec3& p : triangle.points) {
      const sizing::GridPoint place = lattice.frame.cell_at(lattice.frame.to_grid(p));
      if (tree.is_own(tree.any_at(place))) continue;
      const GridBox cell = GridBox::of({place, sizing::finest_level});
      add_query({0.5 * (cell.low + cell.high), 0.5 * (cell.low + cell.high)});
    }
  }
  return fetch_blocks(lattice, queries, [&](std::span<const BlockQuery> of_rank, const auto& add) {
    const BoxesByLevel boxes(of_rank);
    add_own_blocks(
        tree, [&](const GridCube& cube) { return boxes.any_from(0, GridBox::of(cube)); }, add);
  });
}

std::vector<GhostBlock> fetch_finer_ghosts(const Lattice& lattice) {
  const LatticeTree& tree = lattice.tree;
  const SurfaceTable& table = lattice.table;
  if (tree.communicator().size() == 1) return {};
  const ScopedCpu task(ScopedCpu::As::task);
  BlockQueries queries(tree);
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    for (const double radius : finer_search_radii(lattice, b)) {
      const GridBox box = GridBox::of(tree.cube(b)).dilated(radius);
      queries.add(box, {.box = box, .level = tree.level(b)});
    }
  }
  return fetch_blocks(lattice, queries, [&](std::span<const BlockQuery> of_rank, const auto& add) {
    for (const BlockQuery& query : of_rank) {
      tree.any_block_in(
          query.box,
          [&](BlockIndex b) {
            if (!table.is_met(b) || tree.level(b) < far_finer_level(query.level)) return false;
            add(b);
            return true;
          },
          [&](BlockIndex first, BlockIndex last, const GridCube&) {
            return last <= tree.first() || first >= tree.last() ||
                   !table.any_met(first, last, far_finer_level(query.level));
          });
    }
  });
}

}  // namespace aeroloom::volume
