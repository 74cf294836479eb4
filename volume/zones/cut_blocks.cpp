#include "volume/zones/cut_blocks.hpp"

#include "volume/lattice/learn_blocks.hpp"
#include "volume/zones/halo.hpp"

#include <span>
#include <utility>
#include <vector>

namespace aeroloom::volume {

void learn_what_is_cut(const parallel::Communicator& communicator, const KnownLattice& lattice,
                       const ZoneCuts& cuts, double width) {
  const LatticeFrame& frame = lattice.frame;
  LatticeTree& tree = lattice.tree;
  SurfaceTable& table = lattice.table;
  if (communicator.size() == 1) return;
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  std::vector<Question> questions;
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    const GridBox box =
        GridBox::of(tree.cube(b)).dilated(ZonesAround::search_radius(frame, tree, table, b, width));
    ask(tree, box, {box, 0, 0, tree.level(b), 0, communicator.rank()}, questions);
  }
  learn(communicator, tree, table, std::move(questions),
        [&](std::span<const Question> asked, const auto& add) {
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
}

}  // namespace aeroloom::volume
