#include "volume/core_border.hpp"

#include <algorithm>

namespace aeroloom::volume {

namespace {

/// Whether core leaves touch a block, and leaves of the shell.
struct Company {
  bool core = false, shell = false;

  Company(const LeafSurroundings& around, const CoreLeaves& core_leaves) {
    for (int k = -1; k <= around.width(); ++k) {
      for (int j = -1; j <= around.width(); ++j) {
        for (int i = -1; i <= around.width(); ++i) {
          const LeafSurroundings::Cube& cube = around.cube({i, j, k});
          if (cube.size == LeafSurroundings::Size::finer) {
            core = shell = true;  // as far as this is asked for
          } else {
            const bool is_core =
                cube.size != LeafSurroundings::Size::outside && core_leaves.is_core(cube.leaf);
            (is_core ? core : shell) = true;
          }
        }
      }
    }
  }
};

}  // namespace

ShellShare find_shell(const LatticeTree& tree, const CoreLeaves& core, const CoreSquares& squares,
                      BlockPoints points) {
  ShellShare share;
  BlockPoints& kept = share.points;
  kept.first = share.borders.first = points.first;
  kept.starts.push_back(0);
  share.borders.starts.push_back(0);
  LeafSurroundings around(tree);
  CoreCells cells(tree, core, squares);
  const BlockIndex last = points.last();
  for (BlockIndex b = points.first; b < last; ++b) {
    const std::int64_t begin = points.starts[b - points.first], end = points.starts[b - points.first + 1];
    around.move_to(b);
    const Company company(around, core);
    for (std::int64_t i = begin; i < end; ++i) {
      const int child = points.slots[i] / slots_per_leaf;
      const HalfPlace leaf = around.place_of(child);
      const int(&place)[3] = slot_places[points.slots[i] % slots_per_leaf];
      const HalfPlace at{2 * leaf[0] + place[0], 2 * leaf[1] + place[1], 2 * leaf[2] + place[2]};
      if (company.core && (!company.shell || !core.is_of_shell(around, at))) continue;
      kept.slots.push_back(points.slots[i]);
      kept.points.push_back(points.points[i]);
      kept.regions.push_back(points.regions[i]);
    }
    kept.starts.push_back(static_cast<std::int64_t>(kept.points.size()));
    std::uint8_t deep = 0;
    std::uint16_t inner_cells = 0, border_cells = 0;
    if (const std::uint8_t leaves = core.of(b); leaves != 0) {
      cells.make(b);
      share.borders.triangles.insert(share.borders.triangles.end(), cells.borders().begin(),
                                     cells.borders().end());
      inner_cells =
          static_cast<std::uint16_t>(std::count_if(cells.cells().begin(), cells.cells().end(),
                                                   [](const CoreCell& cell) { return cell.of_shell == 0; }));
      border_cells = static_cast<std::uint16_t>(cells.cells().size() - inner_cells);
      for (int child = 0; child < 8; ++child) {
        if ((leaves >> child & 1) && (!company.shell || cells.is_deep(child)))
          deep |= static_cast<std::uint8_t>(1U << child);
      }
    }
    share.deep.push_back(deep);
    share.inner_cells.push_back(inner_cells);
    share.border_cells.push_back(border_cells);
    share.borders.starts.push_back(static_cast<std::int64_t>(share.borders.triangles.size()));
  }
  return share;
}

}  // namespace aeroloom::volume
