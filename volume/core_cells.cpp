#include "volume/core_cells.hpp"

namespace aeroloom::volume {

namespace {

constexpr int center_slot = 7;

std::int64_t center_of(const LatticeTree& tree, const Leaf& leaf) {
  return lattice_number(tree, leaf.block, leaf.child * slots_per_leaf + center_slot);
}

}  // namespace

CoreCells::CoreCells(const LatticeTree& tree, const CoreLeaves& core, const CoreSquares& squares)
    : _core(core), _squares(squares), _around(tree) {}

void CoreCells::move_to(BlockIndex b) {
  _cells.clear();
  _borders.clear();
  _around.move_to(b);
  _known.fill(0);
}

void CoreCells::make(BlockIndex b) {
  move_to(b);
  make_here();
}

void CoreCells::make_here() {
  const std::uint8_t core = _core.of(_around.block());
  for (int child = 0; child < 8; ++child) {
    if (!(core >> child & 1)) continue;
    for (int side = 0; side < 6; ++side)
      make_side(child, _around.place_of(child), side / 2, side % 2 == 0 ? -1 : 1);
  }
}

bool CoreCells::is_deep(int child) {
  return _around.all_points_of(_around.place_of(child),
                               [&](const HalfPlace& at) { return !point(at).of_shell; });
}

const CoreCells::Point& CoreCells::point(const HalfPlace& at) {
  const int i = at[0] + 5 * at[1] + 25 * at[2];
  if (!_known[i]) {
    _points[i] = {_around.number(at), _core.is_of_shell(_around, at)};
    _known[i] = 1;
  }
  return _points[i];
}

/// What lies between a core leaf and the cube beside it, unless that is counted to what is there.
void CoreCells::make_side(int child, const HalfPlace& leaf, int axis, int sign) {
  using Size = LeafSurroundings::Size;
  const int b = (axis + 1) % 3, d = (axis + 2) % 3;
  HalfPlace beyond = leaf;
  beyond[axis] += sign;
  const LeafSurroundings::Cube& cube = _around.cube(beyond);
  const Point center{center_of(_around.tree(), {_around.block(), child}), false};
  const auto take_square = [&](int first_b, int first_d, int step) {
    _pattern = 0;
    for (int k = 0; k < 8; ++k) {
      if (step == 1 && k % 2 == 1) continue;
      HalfPlace at;
      at[axis] = 2 * leaf[axis] + (sign > 0 ? 2 : 0);
      at[b] = first_b + square_places[k][0] * step / 2;
      at[d] = first_d + square_places[k][1] * step / 2;
      if (k % 2 == 1 && !_around.has_point(at)) continue;
      if (k % 2 == 1) _pattern |= 1U << k / 2;
      _square[k] = point(at);
    }
  };
  const auto cover = [&](const Leaf& other, bool counts_both) {
    const bool is_core = _core.is_core(other);
    if (is_core && !counts_both) return;
    const Point across{is_core ? center_of(_around.tree(), other) : -1, false};
    for (const auto& [p, q, r] : _squares.triangles(axis, _pattern)) {
      const Point *x = &_square[p], *y = &_square[q], *z = &_square[r];
      // Seen against the axis they turn counter-clockwise: the volume above is positive.
      if (sign > 0) std::swap(y, z);
      add_cell(child, {x, y, z, &center});
      if (is_core)
        add_cell(child, {x, z, y, &across});
      else
        _borders.push_back({{x->number, y->number, z->number}, static_cast<std::uint8_t>(child)});
    }
  };
  if (cube.size == Size::finer) {
    for (int part = 0; part < 4; ++part) {
      std::array<int, 3> octant;
      octant[axis] = sign > 0 ? 0 : 1;
      octant[b] = part & 1;
      octant[d] = part >> 1;
      const Leaf other = _around.finer(beyond, octant[0] + 2 * octant[1] + 4 * octant[2]);
      take_square(2 * leaf[b] + octant[b], 2 * leaf[d] + octant[d], 1);
      cover(other, false);
    }
    return;
  }
  if (cube.size == Size::same && sign < 0 && _core.is_core(cube.leaf)) return;
  take_square(2 * leaf[b], 2 * leaf[d], 2);
  const bool is_core = cube.size == Size::same && _core.is_core(cube.leaf);
  const unsigned claims = cube.size == Size::same && !is_core ? _core.claims(cube.leaf) : 0;
  if (!is_core && !(claims >> (2 * axis + (sign < 0)) & 1)) return cover(cube.leaf, true);
  const Point across{center_of(_around.tree(), cube.leaf), !is_core && claims != CoreLeaves::all_sides};
  const Point &below = sign > 0 ? center : across, &above = sign > 0 ? across : center;
  // Beyond each edge of the square lies another side of the leaf across it.
  const int beyond_edge[4] = {2 * d, 2 * b + 1, 2 * d + 1, 2 * b};
  const Point* last = &_square[0];
  for (int k = 1; k <= 8; ++k) {
    if (k % 2 == 1 && !(_pattern >> k / 2 & 1)) continue;
    const Point* next = &_square[k % 8];
    add_cell(child, {&below, last, next, &above});
    if (!is_core && !(claims >> beyond_edge[k / 2 - 1] & 1)) {
      const Point *x = sign > 0 ? next : last, *y = sign > 0 ? last : next;
      _borders.push_back({{x->number, y->number, across.number}, static_cast<std::uint8_t>(child)});
    }
    last = next;
  }
}

void CoreCells::add_cell(int child, const std::array<const Point*, 4>& points) {
  CoreCell& cell = _cells.emplace_back();
  cell.child = static_cast<std::uint8_t>(child);
  cell.of_shell = 0;
  for (int k = 0; k < 4; ++k) {
    cell.points[k] = points[k]->number;
    if (points[k]->of_shell) cell.of_shell |= static_cast<std::uint8_t>(1U << k);
  }
}

}  // namespace aeroloom::volume
