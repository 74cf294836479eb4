#include "volume/core/core_leaves.hpp"

#include "geometry/sort_unique.hpp"
#include "parallel/observation/timers.hpp"

#include <utility>

namespace aeroloom::volume {

using mesh::RegionId;
using parallel::ScopedCpu;

CoreLeaves::CoreLeaves(const LatticeTree& tree, std::span<const BlockChange> changes,
                       const BlockPoints& points)
    : _ghosts(tree), _core(_ghosts.count(), 0), _present(_ghosts.count()) {
  {
    const ScopedCpu task(ScopedCpu::As::task);
    for (std::size_t i = 0; i < _ghosts.own_count(); ++i) {
      const std::int64_t first = points.starts[i], last = points.starts[i + 1];
      if (first == last) continue;
      const RegionId region = points.regions[first];
      bool is_one = true;
      for (std::int64_t p = first; p < last; ++p) {
        _present[i].slots |= std::uint64_t{1} << points.slots[p];
        is_one = is_one && points.regions[p] == region;
      }
      if (is_one) _present[i].region = region;
    }
  }
  _ghosts.update(_present);
  {
    const ScopedCpu task(ScopedCpu::As::task);
    choose(tree, changes, points);
  }
  _ghosts.update(_core);
  demote_until_stable(tree);
  {
    const ScopedCpu task(ScopedCpu::As::task);
    claim(tree);
  }
  _ghosts.update(_claims);
  _regions.reserve(_ghosts.own_count());
  for (std::size_t i = 0; i < _ghosts.own_count(); ++i) _regions.push_back(_present[i].region);
  std::vector<Present>().swap(_present);
}

std::vector<BlockIndex> CoreLeaves::blocks_unlike(const CoreLeaves& other) const {
  std::vector<BlockIndex> found;
  for (std::size_t i = 0; i < _ghosts.own_count(); ++i) {
    if (_core[i] != other._core[i]) found.push_back(_ghosts.first() + static_cast<BlockIndex>(i));
  }
  return found;
}

/// Whether all leaves around have one size and all their points in the region. Saves a search.
bool CoreLeaves::has_all_around(const LeafSurroundings& around, RegionId region) const {
  constexpr std::uint64_t corner_and_center = 0x81;
  bool all = true;
  around.for_each_cube([&](const LeafSurroundings::Cube& cube) {
    if (!all || cube.size != LeafSurroundings::Size::same) {
      all = false;
      return;
    }
    const Present& has = _present[_ghosts.place(cube.leaf.block)];
    const std::uint64_t wanted = corner_and_center << cube.leaf.child * slots_per_leaf;
    all = has.region == region && (has.slots & wanted) == wanted;
  });
  return all;
}

/// Chooses the leaves whose points all exist and that keep their distance from the surface.
void CoreLeaves::choose(const LatticeTree& tree, std::span<const BlockChange> changes,
                        const BlockPoints& points) {
  LeafSurroundings around(tree);
  for (std::size_t i = 0; i < _ghosts.own_count(); ++i) {
    const BlockIndex b = _ghosts.first() + static_cast<BlockIndex>(i);
    const RegionId region = _present[i].region;
    const auto candidates = static_cast<std::uint8_t>(points.clear_leaves[i] & ~changes[b].shell);
    if (region == mesh::no_region || candidates == 0) continue;
    around.move_to(b);
    if (has_all_around(around, region)) {
      _core[i] = candidates & tree.all_leaves(b);
      continue;
    }
    const auto exists = [&](const HalfPlace& at) {
      const std::int64_t number = around.number(at);
      if (number < 0) return false;
      const Present& has = _present[_ghosts.place(tree.index(number / slots_per_block))];
      return has.region == region && (has.slots >> number % slots_per_block & 1) != 0;
    };
    for (int child = 0; child < tree.leaf_count(b); ++child) {
      if ((candidates >> child & 1) && around.all_points_of(around.place_of(child), exists))
        _core[i] |= static_cast<std::uint8_t>(1U << child);
    }
  }
}

/// Whether one of the two rules demotes a core leaf of the block (core_leaves.hpp).
bool CoreLeaves::is_demoted(const LeafSurroundings& around, const HalfPlace& leaf) const {
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2, b = (axis + 1) % 3, d = (axis + 2) % 3, sign = side % 2 == 0 ? -1 : 1;
    HalfPlace across = leaf;
    across[axis] += sign;
    const LeafSurroundings::Cube& cube = around.cube(across);
    if (cube.size != LeafSurroundings::Size::same || is_core(cube.leaf)) continue;
    const int on_edges = around.points_on_edges(leaf, side);
    if (on_edges == 4) return true;
    if (on_edges > 0) continue;
    const HalfPlace center{2 * leaf[0] + 1, 2 * leaf[1] + 1, 2 * leaf[2] + 1};
    const auto moved = [](HalfPlace at, int along, int by) {
      at[along] += by;
      return at;
    };
    const auto stands_at = [&](const HalfPlace& at) {
      return around.has_point(at) && is_of_shell(around, at);
    };
    for (int across = 0; across < 4; ++across) {
      if (stands_at(moved(moved(center, b, across & 1 ? 1 : -1), d, across & 2 ? 1 : -1))) return true;
    }
    if (stands_at(moved(center, axis, -sign))) return true;
  }
  return false;
}

/// Whether a leaf has a part of the shell at a place. A shell leaf has none at a corner where the core claims
/// all three sides, and none at its centre where it claims all six.
bool CoreLeaves::has_shell_at(const Leaf& leaf, const LeafSurroundings& around, const HalfPlace& at) const {
  if (is_core(leaf)) return false;
  if (_claims.empty()) return true;  // while leaves are still demoted
  const unsigned claimed = claims(leaf);
  if (claimed == 0) return true;
  if ((at[0] & 1) && (at[1] & 1) && (at[2] & 1)) return claimed != all_sides;
  unsigned sides = 0;
  const std::array<Along, 3> where = around.place_in(leaf, at);
  for (int axis = 0; axis < 3; ++axis) {
    if (where[axis] == Along::between) return true;
    sides |= 1U << (2 * axis + (where[axis] == Along::high));
  }
  return (claimed & sides) != sides;
}

/// Finds the plain squares between core leaves and shell leaves of the same size with a centre point.
void CoreLeaves::claim(const LatticeTree& tree) {
  constexpr int center_slot = 7;
  _claims.assign(_ghosts.count(), 0);
  LeafSurroundings around(tree);
  for (std::size_t i = 0; i < _ghosts.own_count(); ++i) {
    const BlockIndex b = _ghosts.first() + static_cast<BlockIndex>(i);
    if (_core[i] == tree.all_leaves(b) || _present[i].region == mesh::no_region) continue;
    around.move_to(b);
    for (int child = 0; child < tree.leaf_count(b); ++child) {
      if ((_core[i] >> child & 1) || !(_present[i].slots >> (child * slots_per_leaf + center_slot) & 1))
        continue;
      const HalfPlace leaf = around.place_of(child);
      for (int side = 0; side < 6; ++side) {
        HalfPlace across = leaf;
        across[side / 2] += side % 2 == 0 ? -1 : 1;
        const LeafSurroundings::Cube& cube = around.cube(across);
        if (cube.size == LeafSurroundings::Size::same && is_core(cube.leaf) &&
            _present[_ghosts.place(cube.leaf.block)].region == _present[i].region &&
            around.points_on_edges(leaf, side) == 0)
          _claims[i] |= std::uint64_t{1} << (6 * child + side);
      }
    }
  }
}

bool CoreLeaves::is_beside_shell(const LeafSurroundings& around) const {
  bool found = false;
  around.for_each_cube([&](const LeafSurroundings::Cube& cube) {
    using Size = LeafSurroundings::Size;
    found = found || cube.size == Size::outside || cube.size == Size::finer || !is_core(cube.leaf);
  });
  return found;
}

void CoreLeaves::demote_until_stable(const LatticeTree& tree) {
  LeafSurroundings around(tree);
  std::vector<std::size_t> open;  // own blocks whose leaves must be checked
  _beside_shell.assign(_ghosts.own_count(), 0);
  {
    const ScopedCpu task(ScopedCpu::As::task);
    for (std::size_t i = 0; i < _ghosts.own_count(); ++i) {
      if (_core[i] == 0) continue;
      around.move_to(_ghosts.first() + static_cast<BlockIndex>(i));
      if (!is_beside_shell(around)) continue;
      _beside_shell[i] = 1;
      open.push_back(i);
    }
  }
  const auto open_beside = [&](BlockIndex b) {
    tree.for_each_own_block_in(GridBox::of(tree.cube(b)).dilated(0.5), [&](BlockIndex n) {
      if (of(n) == 0) return;
      _beside_shell[_ghosts.place(n)] = 1;
      open.push_back(_ghosts.place(n));
    });
  };
  for (bool changed = true; changed;) {
    changed = false;
    {
      const ScopedCpu task(ScopedCpu::As::task);
      geometry::sort_unique(open);
      for (const std::size_t i : std::exchange(open, {})) {
        around.move_to(_ghosts.first() + static_cast<BlockIndex>(i));
        const std::uint8_t before = _core[i];
        for (int child = 0; child < 8; ++child) {
          if ((_core[i] >> child & 1) && is_demoted(around, around.place_of(child)))
            _core[i] &= static_cast<std::uint8_t>(~(1U << child));
        }
        if (_core[i] == before) continue;
        changed = true;
        open_beside(around.block());
      }
    }
    changed = tree.communicator().maximum(std::int64_t{changed}) > 0;
    if (!changed || tree.communicator().size() == 1) continue;
    const std::vector<std::uint8_t> before(_core.begin() + static_cast<std::ptrdiff_t>(_ghosts.own_count()),
                                           _core.end());
    _ghosts.update(_core);
    const ScopedCpu task(ScopedCpu::As::task);
    for (std::size_t g = 0; g < before.size(); ++g) {
      if (before[g] != _core[_ghosts.own_count() + g]) open_beside(_ghosts.ghost(g));
    }
  }
}

}  // namespace aeroloom::volume
