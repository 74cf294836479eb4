/// The leaves around a block, and the points of the lattice on the faces of its own leaves.
#pragma once

#include "volume/lattice/block_points.hpp"
#include "volume/lattice/lattice_tree.hpp"

#include <array>
#include <cstdint>

namespace aeroloom::volume {

/// A place on the grid of half leaf edges of a block, from its low corner: 0 to 2 along each axis where the
/// block is one leaf, 0 to 4 where it has eight. Even along all axes: a corner of leaves; odd along one, two,
/// three: the middle of an edge, a face, a leaf.
using HalfPlace = std::array<int, 3>;

/// Where a place stands in a leaf that it touches, along one axis.
enum class Along : std::int8_t { low, between, high };

/// Eight leaves of one parent, or a leaf alone, seen with the leaves that touch them. These differ by one
/// level at most, so all points of the lattice on faces of the block's leaves stand at half places.
class LeafSurroundings {
public:
  explicit LeafSurroundings(const LatticeTree& tree) : _tree(tree) {}

  void move_to(BlockIndex b);
  BlockIndex block() const { return _block; }
  /// Leaves along an axis: 1 or 2.
  int width() const { return _width; }
  /// Where a leaf of the block stands in it, in leaves.
  HalfPlace place_of(int child) const {
    return _width == 1 ? HalfPlace{0, 0, 0} : HalfPlace{child & 1, child >> 1 & 1, child >> 2};
  }

  enum class Size : std::int8_t { outside, coarser, same, finer };
  /// A cube of the size of the block's leaves: the leaf that holds it, unless it is split into finer ones.
  struct Cube {
    Size size = Size::outside;
    Leaf leaf{};
  };
  /// Leaves of the block and of those that touch it: -1 to width() along each axis, in leaves.
  const LatticeTree& tree() const { return _tree; }
  const Cube& cube(const HalfPlace& at) const {
    return _cubes[(at[0] + 1) + 4 * (at[1] + 1) + 16 * (at[2] + 1)];
  }
  /// The leaf in an octant of a cube that is split.
  Leaf finer(const HalfPlace& at, int octant) const;

  /// Calls visit(cube) for all of them.
  template <class Visit>
  void for_each_cube(const Visit& visit) const {
    for (int k = -1; k <= _width; ++k) {
      for (int j = -1; j <= _width; ++j) {
        for (int i = -1; i <= _width; ++i) visit(cube({i, j, k}));
      }
    }
  }

  /// Whether a point of the lattice stands at a half place of the block: at all corners and centres, in the
  /// middle of edges and faces that finer leaves touch.
  bool has_point(const HalfPlace& at) const;
  /// How many points stand in the middles of edges of a leaf's square: side 2 a of axis a is its low one.
  int points_on_edges(const HalfPlace& leaf, int side) const;
  /// The running number of such a point; -1 where the leaf that it would belong to lies outside of the root.
  std::int64_t number(const HalfPlace& at) const;
  /// Where a half place stands in a leaf that touches it.
  std::array<Along, 3> place_in(const Leaf& leaf, const HalfPlace& at) const;
  /// Whether holds(half place) for all points of the lattice on a leaf of the block.
  template <class Holds>
  bool all_points_of(const HalfPlace& leaf, const Holds& holds) const;
  /// Whether holds(leaf) for one of the leaves that touch a half place, or the root ends there.
  template <class Holds>
  bool any_leaf_at(const HalfPlace& at, const Holds& holds) const;

private:
  void look_at(const HalfPlace& first, const HalfPlace& last);
  sizing::GridPoint grid_place(const HalfPlace& cube, std::uint32_t unit) const {
    return {_low.x + static_cast<std::uint32_t>(cube[0]) * unit,
            _low.y + static_cast<std::uint32_t>(cube[1]) * unit,
            _low.z + static_cast<std::uint32_t>(cube[2]) * unit};
  }
  Leaf leaf_at(sizing::GridPoint p) const {
    const BlockIndex b = _tree.block_at(p);
    return {b, _tree.child_at(b, p)};
  }

  const LatticeTree& _tree;
  BlockIndex _block = 0;
  int _width = 1;
  sizing::GridPoint _low;
  std::uint32_t _edge = 0;  ///< of a leaf
  std::array<Cube, 64> _cubes;
};

template <class Holds>
bool LeafSurroundings::all_points_of(const HalfPlace& leaf, const Holds& holds) const {
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        const HalfPlace at{2 * leaf[0] + i, 2 * leaf[1] + j, 2 * leaf[2] + k};
        if (has_point(at) && !holds(at)) return false;
      }
    }
  }
  return true;
}

template <class Holds>
bool LeafSurroundings::any_leaf_at(const HalfPlace& at, const Holds& holds) const {
  // Along each axis the cubes that touch the place, and which of their halves do.
  struct Touch {
    int cube, halves;  // a bit each: low, high
  };
  std::array<std::array<Touch, 2>, 3> touching;
  std::array<int, 3> count;
  for (int axis = 0; axis < 3; ++axis) {
    const int cube = at[axis] >> 1;
    if (at[axis] & 1) {
      touching[axis][0] = {cube, 3};
      count[axis] = 1;
    } else {
      touching[axis] = {Touch{cube - 1, 2}, Touch{cube, 1}};
      count[axis] = 2;
    }
  }
  for (int k = 0; k < count[2]; ++k) {
    for (int j = 0; j < count[1]; ++j) {
      for (int i = 0; i < count[0]; ++i) {
        const Touch &x = touching[0][i], &y = touching[1][j], &z = touching[2][k];
        const HalfPlace where{x.cube, y.cube, z.cube};
        const Cube& c = cube(where);
        if (c.size == Size::outside) return true;
        if (c.size != Size::finer) {
          if (holds(c.leaf)) return true;
          continue;
        }
        for (int octant = 0; octant < 8; ++octant) {
          if ((x.halves >> (octant & 1) & 1) && (y.halves >> (octant >> 1 & 1) & 1) &&
              (z.halves >> (octant >> 2) & 1) && holds(finer(where, octant)))
            return true;
        }
      }
    }
  }
  return false;
}

}  // namespace aeroloom::volume
