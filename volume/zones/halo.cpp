#include "volume/zones/halo.hpp"

#include "parallel/observation/timers.hpp"
#include "volume/lattice/fetch_blocks.hpp"

#include <algorithm>

namespace aeroloom::volume {

double largest_size_around(const Lattice& lattice, BlockIndex b) {
  const LatticeTree& tree = lattice.tree;
  double size = 0;
  tree.for_each_block_in(GridBox::of(tree.cube(b)).dilated(0.5), [&](BlockIndex n) {
    size = std::max({size, mean_edge_of_cell * lattice.frame.edge(tree.leaf_level(n)),
                     double{lattice.table.longest_edge[n]}});
  });
  return size;
}

bool HaloZone::reaches(const GridBox& box) const {
  return std::any_of(boxes.begin(), boxes.end(),
                     [&](const GridBox& place) { return place.gap_to(box) <= radius; });
}

ZonesAround::ZonesAround(const Lattice& lattice, const Zones& zones, std::span<const double> widths)
    : _lattice(lattice),
      _zones(zones),
      _widths(widths),
      _widest(*std::max_element(widths.begin(), widths.end())) {}

void ZonesAround::find_places(const GridCube& cube, const GridBox& around, int finest) {
  const GridBox box = GridBox::of(cube);
  if (!box.overlaps(around)) return;
  const ZoneCuts& cuts = _zones.cuts();
  if (const ZoneIndex zone = cuts.zone_of_all(cube); zone != no_zone) {
    _places.push_back({_zones.name(zone), box});
    return;
  }
  if (cube.level >= finest) {
    cuts.for_each_zone_in(cube, [&](ZoneIndex zone) { _places.push_back({_zones.name(zone), box}); });
    return;
  }
  if (_zones.is_block(cube)) {
    _places.push_back({_zones.name(cuts.zone_of(cube)), box});
    return;
  }
  for (int c = 0; c < 8; ++c) find_places(cube.child(c), around, finest);
}

void ZonesAround::move_to(BlockIndex b) {
  const GridBox block = GridBox::of(_lattice.tree.cube(b));
  const double size = largest_size_around(_lattice, b);
  const GridBox around =
      block.dilated(_lattice.frame.grid_distance(_widest * size + _lattice.table.longest_edge[b]));
  _places.clear();
  find_places(LatticeTree::smallest_cube(around), around,
              std::min(_lattice.tree.level(b) + finer_levels, sizing::finest_level));
  for (const ReassignedLeaf& leaf : _zones.reassigned()) {
    if (leaf.box.overlaps(around)) _places.push_back({leaf.zone, leaf.box});
  }
  std::stable_sort(_places.begin(), _places.end(),
                   [](const ZoneBox& a, const ZoneBox& b) { return a.zone < b.zone; });
  _boxes.clear();
  _halos.clear();
  for (const ZoneBox& place : _places) _boxes.push_back(place.box);
  for (std::size_t first = 0, last; first < _places.size(); first = last) {
    const ZoneIndex zone = _places[first].zone;
    for (last = first + 1; last < _places.size() && _places[last].zone == zone;) ++last;
    _halos.push_back({zone, _lattice.frame.grid_distance(_widths[zone] * size),
                      std::span<const GridBox>(_boxes).subspan(first, last - first)});
  }
}

std::vector<GridCube> fetch_cut_ghosts(const Lattice& lattice, const ZoneCuts& cuts, double width) {
  const LatticeTree& tree = lattice.tree;
  if (tree.communicator().size() == 1) return {};
  const parallel::ScopedCpu task(parallel::ScopedCpu::As::task);
  BlockQueries queries(tree);
  for (BlockIndex b = tree.first(); b < tree.last(); ++b) {
    const GridBox box = GridBox::of(tree.cube(b)).dilated(ZonesAround::search_radius(lattice, b, width));
    queries.add(box, {.box = box, .level = tree.level(b)});
  }
  const std::vector<GhostBlock> ghosts =
      fetch_blocks(lattice, queries, [&](std::span<const BlockQuery> of_rank, const auto& add) {
        const BoxesByLevel boxes(of_rank);
        add_own_blocks(
            tree,
            [&](const GridCube& cube) {
              return cuts.zone_of_all(cube) == no_zone &&
                     boxes.any_from(cube.level - ZonesAround::finer_levels + 1, GridBox::of(cube));
            },
            add);
      });
  std::vector<GridCube> cubes;
  cubes.reserve(ghosts.size());
  for (const GhostBlock& ghost : ghosts) cubes.push_back(ghost.block.cube());
  return cubes;
}

}  // namespace aeroloom::volume
