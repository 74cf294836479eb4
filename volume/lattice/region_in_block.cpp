#include "volume/lattice/region_in_block.hpp"

#include <algorithm>

namespace aeroloom::volume {

using geometry::Vec3;

void RegionInBlock::find_targets(BlockIndex b) {
  _block = b;
  _targets.clear();
  const GridBox cube = GridBox::of(_lattice.tree.cube(b));
  // The box of a triangle in the grid may meet the block where its box in space does not.
  const geometry::Box around = _lattice.frame.space_box(cube).dilated(_lattice.table.longest_edge[b]);
  _surface.distance().for_each_in(around, [&](const BoundaryDistance::Measured& found) {
    const auto& [a, second, c] = found.corners;
    if (grid_box(_lattice.frame, {a, second, c}).overlaps(cube))
      _targets.push_back({found.triangle, (1.0 / 3.0) * (a + second + c)});
  });
}

std::optional<RegionInBlock::Found> RegionInBlock::find(BlockIndex b, Vec3 p) {
  if (_surface.empty()) return std::nullopt;
  if (b != _block) find_targets(b);
  std::sort(_targets.begin(), _targets.end(), [&](const Target& left, const Target& right) {
    return distance(left.center, p) < distance(right.center, p);
  });
  for (const Target& target : _targets) {
    if (const auto region = _surface.region_towards(p, target.center, target.triangle))
      return Found{*region, target.triangle};
  }
  return std::nullopt;
}

}  // namespace aeroloom::volume
