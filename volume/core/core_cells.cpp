#include "volume/core/core_cells.hpp"

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
      make_side({child, _around.place_of(child), side / 2, side % 2 == 0 ? -1 : 1});
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

/// Takes the points of a square on the side, `step` half leaf edges wide, from its low corner.
void CoreCells::take_square(const Side& side, int first, int second, int step) {
  _pattern = 0;
  for (int k = 0; k < 8; ++k) {
    if (step == 1 && k % 2 == 1) continue;
    HalfPlace at;
    at[side.axis] = 2 * side.leaf[side.axis] + (side.sign > 0 ? 2 : 0);
    at[side.first_axis()] = first + square_places[k][0] * step / 2;
    at[side.second_axis()] = second + square_places[k][1] * step / 2;
    if (k % 2 == 1 && !_around.has_point(at)) continue;
    if (k % 2 == 1) _pattern |= 1U << k / 2;
    _square[k] = point(at);
  }
}

/// Makes the pyramid from the centre to the square, and the one of the other leaf if it is core.
void CoreCells::cover_square(const Side& side, const Leaf& other, bool counts_both) {
  const bool is_core = _core.is_core(other);
  if (is_core && !counts_both) return;
  const Point center{center_of(_around.tree(), {_around.block(), side.child}), false};
  const Point across{is_core ? center_of(_around.tree(), other) : -1, false};
  for (const auto& [p, q, r] : _squares.triangles(side.axis, _pattern)) {
    const Point *x = &_square[p], *y = &_square[q], *z = &_square[r];
    // Triangles are counter-clockwise seen against the axis: the volume above is positive.
    if (side.sign > 0) std::swap(y, z);
    add_cell(side.child, {x, y, z, &center});
    if (is_core)
      add_cell(side.child, {x, z, y, &across});
    else
      _borders.push_back({{x->number, y->number, z->number}, static_cast<std::uint8_t>(side.child)});
  }
}

/// Makes a tetrahedron for each edge of the square, or half edge, around the line between two centres.
void CoreCells::surround_axis(const Side& side, const Leaf& other) {
  const bool is_core = _core.is_core(other);
  const unsigned claims = is_core ? 0 : _core.claims(other);
  const Point center{center_of(_around.tree(), {_around.block(), side.child}), false};
  const Point across{center_of(_around.tree(), other), !is_core && claims != CoreLeaves::all_sides};
  const Point &below = side.sign > 0 ? center : across, &above = side.sign > 0 ? across : center;
  // The sides of the other leaf at the four edges of the square.
  const int b = side.first_axis(), d = side.second_axis();
  const int across_edge[4] = {2 * d, 2 * b + 1, 2 * d + 1, 2 * b};
  const Point* last = &_square[0];
  for (int k = 1; k <= 8; ++k) {
    if (k % 2 == 1 && !(_pattern >> k / 2 & 1)) continue;
    const Point* next = &_square[k % 8];
    add_cell(side.child, {&below, last, next, &above});
    if (!is_core && !(claims >> across_edge[k / 2 - 1] & 1)) {
      const Point *x = side.sign > 0 ? next : last, *y = side.sign > 0 ? last : next;
      _borders.push_back({{x->number, y->number, across.number}, static_cast<std::uint8_t>(side.child)});
    }
    last = next;
  }
}

/// Makes the cells between a core leaf and the cube beside it, unless that cube makes them.
void CoreCells::make_side(const Side& side) {
  using Size = LeafSurroundings::Size;
  const int b = side.first_axis(), d = side.second_axis();
  HalfPlace across = side.leaf;
  across[side.axis] += side.sign;
  const LeafSurroundings::Cube& cube = _around.cube(across);
  if (cube.size == Size::finer) {
    for (int part = 0; part < 4; ++part) {
      std::array<int, 3> octant;
      octant[side.axis] = side.sign > 0 ? 0 : 1;
      octant[b] = part & 1;
      octant[d] = part >> 1;
      const Leaf other = _around.finer(across, octant[0] + 2 * octant[1] + 4 * octant[2]);
      take_square(side, 2 * side.leaf[b] + octant[b], 2 * side.leaf[d] + octant[d], 1);
      cover_square(side, other, false);
    }
    return;
  }
  const bool is_same = cube.size == Size::same;
  const bool is_core = is_same && _core.is_core(cube.leaf);
  if (is_core && side.sign < 0) return;
  take_square(side, 2 * side.leaf[b], 2 * side.leaf[d], 2);
  const unsigned claims = is_same && !is_core ? _core.claims(cube.leaf) : 0;
  if (is_core || claims >> (2 * side.axis + (side.sign < 0)) & 1) return surround_axis(side, cube.leaf);
  cover_square(side, cube.leaf, true);
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
