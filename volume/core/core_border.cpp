#include "volume/core/core_border.hpp"

#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/timers.hpp"

#include <algorithm>
#include <utility>

namespace aeroloom::volume {

namespace {

/// Tetrahedra per core leaf deep in the core: four at each of its six sides, half of them counted by
/// neighbours.
constexpr int cells_per_leaf = 12;

/// Whether core leaves may touch a block. Never false where one does.
bool may_be_beside_core(const LeafSurroundings& around, const CoreLeaves& core) {
  bool found = false;
  around.for_each_cube([&](const LeafSurroundings::Cube& cube) {
    using Size = LeafSurroundings::Size;
    found = found || cube.size == Size::finer || (cube.size != Size::outside && core.is_core(cube.leaf));
  });
  return found;
}

/// Keeps the points of the shell, and finds the border.
void find_shell(const LatticeTree& tree, const BlockPoints& points, LocalShell& shell) {
  BlockPoints& kept = shell.points;
  kept.first = shell.borders.first = points.first;
  kept.starts.push_back(0);
  shell.borders.starts.push_back(0);
  CoreCells cells(tree, shell.core, shell.squares);
  const BlockIndex last = points.last();
  for (BlockIndex b = points.first; b < last; ++b) {
    const std::int64_t begin = points.starts[b - points.first], end = points.starts[b - points.first + 1];
    const std::uint8_t leaves = shell.core.of(b);
    std::uint8_t deep = 0;
    std::uint16_t inner_cells = 0, border_cells = 0;
    const bool all_core = leaves != 0 && !shell.core.is_beside_shell(b);
    if (!all_core && (begin != end || leaves != 0)) cells.move_to(b);
    if (all_core) {
      deep = leaves;
      inner_cells = static_cast<std::uint16_t>(cells_per_leaf * __builtin_popcount(leaves));
    } else if (leaves != 0) {
      cells.make_here();
      shell.borders.triangles.insert(shell.borders.triangles.end(), cells.borders().begin(),
                                     cells.borders().end());
      inner_cells =
          static_cast<std::uint16_t>(std::count_if(cells.cells().begin(), cells.cells().end(),
                                                   [](const CoreCell& cell) { return cell.of_shell == 0; }));
      border_cells = static_cast<std::uint16_t>(cells.cells().size() - inner_cells);
      for (int child = 0; child < 8; ++child) {
        if ((leaves >> child & 1) && cells.is_deep(child)) deep |= static_cast<std::uint8_t>(1U << child);
      }
    }
    if (!all_core && begin != end) {
      const bool all_shell = leaves == 0 && !may_be_beside_core(cells.around(), shell.core);
      for (std::int64_t i = begin; i < end; ++i) {
        const HalfPlace leaf = cells.around().place_of(points.slots[i] / slots_per_leaf);
        const int(&place)[3] = slot_places[points.slots[i] % slots_per_leaf];
        if (!all_shell &&
            !cells.is_of_shell({2 * leaf[0] + place[0], 2 * leaf[1] + place[1], 2 * leaf[2] + place[2]}))
          continue;
        kept.slots.push_back(points.slots[i]);
        kept.points.push_back(points.points[i]);
        kept.regions.push_back(points.regions[i]);
      }
    }
    kept.starts.push_back(static_cast<std::int64_t>(kept.points.size()));
    shell.borders.starts.push_back(static_cast<std::int64_t>(shell.borders.triangles.size()));
    shell.deep.push_back(deep);
    shell.inner_cells.push_back(inner_cells);
    shell.border_cells.push_back(border_cells);
  }
}

}  // namespace

LocalShell make_local_shell(const Lattice& lattice, std::unique_ptr<const LocalSurface> surface,
                            std::vector<BlockChange> changes) {
  using parallel::ScopedCpu;
  BlockPoints points;
  parallel::collectively(lattice.tree.communicator(), ScopedCpu::As::task, [&] {
    points =
        make_points(lattice, changes, lattice.tree.first(), lattice.tree.last(), *surface, lattice.radii);
    surface.reset();
  });
  CoreLeaves core(lattice.tree, changes, points);
  const ScopedCpu task(ScopedCpu::As::task);
  const auto count = static_cast<std::int64_t>(points.points.size());
  LocalShell shell{
      std::move(changes), CoreSquares(lattice.frame), std::move(core), count, {}, {}, {}, {}, {}};
  find_shell(lattice.tree, points, shell);
  return shell;
}

}  // namespace aeroloom::volume
