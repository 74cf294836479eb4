/// The leaves around a block, and the lattice points on the faces of its own leaves.
#pragma once

#include "volume/lattice/block_points.hpp"
#include "volume/lattice/lattice_tree.hpp"

#include <array>
#include <cstdint>

namespace aeroloom::volume {

/// A place in a block, in half leaf edges from its low corner: 0 to 2 along each axis where the block is one
/// leaf, 0 to 4 where it has eight. If all three are even it is a corner of leaves. If one, two or three are
/// odd it is the middle of an edge, of a face, or of a leaf.
using HalfPlace = std::array<int, 3>;

/// Where a place is in a leaf that it touches, along one axis.
enum class Along : std::int8_t { low, between, high };

/// A block and the leaves that touch it. Their levels differ by one at most, so all lattice points on the
/// faces of the block's leaves are at half places.
class LeafSurroundings {
public:
  explicit LeafSurroundings(const LatticeTree& tree) : _tree(tree) {}

  void move_to(BlockIndex b);
  BlockIndex block() const { return _block; }
  /// The number of leaves along an axis: 1 or 2.
  int width() const { return _width; }
  /// The place of a leaf in the block, in leaves.
  HalfPlace place_of(int child) const {
    return _width == 1 ? HalfPlace{0, 0, 0} : HalfPlace{child & 1, child >> 1 & 1, child >> 2};
  }

  enum class Size : std::int8_t { outside, coarser, same, finer };
  /// A cube of the size of the block's leaves, and the leaf that contains it unless it is split.
  struct Cube {
    Size size = Size::outside;
    Leaf leaf{};
  };
  const LatticeTree& tree() const { return _tree; }
  /// A cube of the block or beside it: -1 to width() along each axis, in leaves.
  const Cube& cube(const HalfPlace& at) const {
    return _cubes[(at[0] + 1) + 4 * (at[1] + 1) + 16 * (at[2] + 1)];
  }
  /// The leaf that is an octant of a split cube.
  Leaf finer(const HalfPlace& at, int octant) const;

  /// Calls visit(cube) for all cubes of the block and around it.
  template <class Visit>
  void for_each_cube(const Visit& visit) const {
    for (int k = -1; k <= _width; ++k) {
      for (int j = -1; j <= _width; ++j) {
        for (int i = -1; i <= _width; ++i) visit(cube({i, j, k}));
      }
    }
  }

  /// Whether the lattice has a point at a half place of the block. It has one at all corners and centres, and
  /// in the middle of edges and faces that finer leaves touch.
  bool has_point(const HalfPlace& at) const;
  /// How many edges of a face of a leaf have a point in the middle. Face 2 a is the lower one along axis a.
  int points_on_edges(const HalfPlace& leaf, int side) const;
  /// The lattice_number() of the point at a half place; -1 where its leaf would be outside the root.
  std::int64_t number(const HalfPlace& at) const;
  /// Where a half place is in a leaf that it touches.
  std::array<Along, 3> place_in(const Leaf& leaf, const HalfPlace& at) const;
  /// Whether holds(half place) is true for all lattice points on a leaf of the block.
  template <class Holds>
  bool all_points_of(const HalfPlace& leaf, const Holds& holds) const;
  /// Whether holds(leaf) is true for a leaf that touches a half place, or the place is on the root's
  /// boundary.
  template <class Holds>
  bool any_leaf_at(const HalfPlace& at, const Holds& holds) const;

private:
  void look_at(const HalfPlace& first, const HalfPlace& last);
  sizing::GridPoint grid_place(const HalfPlace& cube, std::uint32_t unit) const {
    return {_low.x + static_cast<std::uint32_t>(cube[0]) * unit,
            _low.y + static_cast<std::uint32_t>(cube[1]) * unit,
            _low.z + static_cast<std::uint32_t>(cube[2]) * unit};
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
