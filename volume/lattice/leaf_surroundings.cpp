#include "volume/lattice/leaf_surroundings.hpp"

namespace aeroloom::volume {

void LeafSurroundings::move_to(BlockIndex b) {
  _block = b;
  const GridCube whole = _tree.cube(b);
  _low = whole.low;
  _width = _tree.leaf_count(b) == 8 ? 2 : 1;
  _edge = whole.edge() / static_cast<std::uint32_t>(_width);
  // Neighbours on one side mostly lie in one other block, so one look-up serves them all.
  for (int side = 0; side < 27; ++side) {
    const HalfPlace sides{side % 3 - 1, side / 3 % 3 - 1, side / 9 - 1};
    HalfPlace first, last;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = sides[axis] < 0 ? -1 : sides[axis] > 0 ? _width : 0;
      last[axis] = sides[axis] == 0 ? _width - 1 : first[axis];
    }
    look_at(first, last);
  }
}

/// Finds the cubes from `first` to `last`, all of them on one side of the block.
void LeafSurroundings::look_at(const HalfPlace& first, const HalfPlace& last) {
  const sizing::GridPoint corner = grid_place(first, _edge);
  const bool outside =
      corner.x >= sizing::grid_size || corner.y >= sizing::grid_size || corner.z >= sizing::grid_size;
  BlockIndex b = outside ? 0 : _tree.any_at(corner);
  const bool is_one = !outside && _tree.is_local(b) && _tree.level(b) <= _tree.level(_block);
  const int level = _tree.leaf_level(_block);
  for (int k = first[2]; k <= last[2]; ++k) {
    for (int j = first[1]; j <= last[1]; ++j) {
      for (int i = first[0]; i <= last[0]; ++i) {
        Cube& cube = _cubes[(i + 1) + 4 * (j + 1) + 16 * (k + 1)];
        if (outside) {
          cube = {};
          continue;
        }
        const sizing::GridPoint low = grid_place({i, j, k}, _edge);
        if (!is_one) b = _tree.any_at(low);
        if (!_tree.is_local(b)) {  // a placeholder: its leaves do not touch the block
          cube = {Size::finer, {b, 0}};
          continue;
        }
        const int other = _tree.leaf_level(b);
        cube = {other > level   ? Size::finer
                : other < level ? Size::coarser
                                : Size::same,
                {b, _tree.child_at(b, low)}};
      }
    }
  }
}

Leaf LeafSurroundings::finer(const HalfPlace& at, int octant) const {
  const std::uint32_t half = _edge / 2;
  sizing::GridPoint low = grid_place(at, _edge);
  if (octant & 1) low.x += half;
  if (octant & 2) low.y += half;
  if (octant & 4) low.z += half;
  return _tree.leaf_at(low);
}

bool LeafSurroundings::has_point(const HalfPlace& at) const {
  const int odd = (at[0] & 1) + (at[1] & 1) + (at[2] & 1);
  if (odd == 0 || odd == 3) return true;
  for (int touch = 0; touch < 8; ++touch) {
    HalfPlace where;
    bool known = true;
    for (int axis = 0; axis < 3; ++axis) {
      const int below = touch >> axis & 1;
      if (at[axis] & 1) known = known && below == 0;
      where[axis] = (at[axis] >> 1) - below;
    }
    if (known && cube(where).size == Size::finer) return true;
  }
  return false;
}

std::array<Along, 3> LeafSurroundings::place_in(const Leaf& leaf, const HalfPlace& at) const {
  const GridCube cube = _tree.leaf(leaf);
  const std::uint32_t low[3] = {cube.low.x, cube.low.y, cube.low.z}, origin[3] = {_low.x, _low.y, _low.z};
  std::array<Along, 3> where;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t p = origin[axis] + static_cast<std::uint32_t>(at[axis]) * _edge / 2;
    where[axis] = p == low[axis] ? Along::low : p == low[axis] + cube.edge() ? Along::high : Along::between;
  }
  return where;
}

int LeafSurroundings::points_on_edges(const HalfPlace& leaf, int side) const {
  const int axis = side / 2;
  int count = 0;
  for (int edge = 0; edge < 4; ++edge) {
    HalfPlace at{2 * leaf[0] + 1, 2 * leaf[1] + 1, 2 * leaf[2] + 1};
    at[axis] += side % 2 == 0 ? -1 : 1;
    at[(axis + 1 + edge / 2) % 3] += edge % 2 == 0 ? -1 : 1;
    count += has_point(at);
  }
  return count;
}

std::int64_t LeafSurroundings::number(const HalfPlace& at) const {
  const HalfPlace where{at[0] >> 1, at[1] >> 1, at[2] >> 1};
  const Cube& c = cube(where);
  const auto of = [&](const Leaf& leaf, int slot) {
    return lattice_number(_tree, leaf.block, leaf.child * slots_per_leaf + slot);
  };
  const std::array<int, 3> half{at[0] & 1, at[1] & 1, at[2] & 1};
  switch (c.size) {
    case Size::outside:
      return -1;
    case Size::same:
      return of(c.leaf, slot_at(half[0], half[1], half[2]));
    case Size::finer:
      return of(finer(where, half[0] + 2 * half[1] + 4 * half[2]), 0);
    case Size::coarser:
      break;
  }
  const GridCube leaf = _tree.leaf(c.leaf);
  const sizing::GridPoint p = grid_place(where, _edge);  // it stands at corners of the block's leaves
  return of(c.leaf, slot_at(p.x != leaf.low.x, p.y != leaf.low.y, p.z != leaf.low.z));
}

}  // namespace aeroloom::volume
