#include "volume/zones/cut_ghosts.hpp"

#include "volume/lattice/fetch_blocks.hpp"
#include "volume/zones/halo.hpp"

#include <span>
#include <utility>
#include <vector>

namespace aeroloom::volume {

std::vector<GridCube> fetch_cut_ghosts(const Lattice& lattice, const ZoneCuts& cuts, double width) {
  const parallel::Communicator& communicator = lattice.tree.communicator();
  const LatticeTree& tree = lattice.tree;
  if (communicator.size() == 1) return {};
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  std::vector<Question> questions;
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    const GridBox box = GridBox::of(tree.cube(b)).dilated(ZonesAround::search_radius(lattice, b, width));
    ask(tree, box, {box, 0, 0, tree.level(b), 0, communicator.rank()}, questions);
  }
  const std::vector<GhostBlock> ghosts =
      fetch_blocks(lattice, std::move(questions), [&](std::span<const Question> asked, const auto& add) {
        const BoxesByLevel boxes(asked);
        const auto is_wanted = [&](const GridCube& cube) {
          return cuts.zone_of_all(cube) == no_zone &&
                 boxes.any_from(cube.level - ZonesAround::finer_levels + 1, GridBox::of(cube));
        };
        tree.any_block_in(
            GridBox::of(GridCube{}),
            [&](BlockIndex b) {
              if (is_wanted(tree.cube(b))) add(b);
              return false;
            },
            [&](BlockIndex first, BlockIndex last, const GridCube& cube) {
              return last <= tree.first() || first >= tree.last() || !is_wanted(cube);
            });
      });
  std::vector<GridCube> cubes;
  cubes.reserve(ghosts.size());
  for (const GhostBlock& ghost : ghosts) cubes.push_back(ghost.block.cube());
  return cubes;
}

}  // namespace aeroloom::volume
