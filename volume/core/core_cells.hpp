/// The tetrahedra of the core and the triangles of its border, block by block.
///
/// A *square* is a face between two leaves; a *plain* square has no points on its edges. Three cases:
/// 1. Two core leaves of one size: one tetrahedron for each edge of the square, or half edge. Its other
///    points are the centres of both leaves. The same at a plain square to a shell leaf of that size with a
///    centre point. The pyramid in the shell leaf is then core, and the border follows its other faces.
/// 2. Two core leaves of different size: two pyramids over the finer square, one to each centre. Both are cut
///    in two by the same diagonal.
/// 3. Otherwise, towards the shell: one pyramid over the finer square, cut with the points on its edges.
#pragma once

#include "volume/core/core_leaves.hpp"
#include "volume/core/core_squares.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// A tetrahedron of the core. Its volume is positive in VTK's order.
struct CoreCell {
  std::array<std::int64_t, 4> points;  ///< numbers of lattice points
  std::uint8_t child;                  ///< the leaf that makes it
  std::uint8_t of_shell;               ///< which points belong to the shell too, as bits
};

/// A triangle between core and shell, counter-clockwise if seen from the core.
struct BorderTriangle {
  std::array<std::int64_t, 3> points;
  std::uint8_t child;  ///< the core leaf beside it
};

/// Makes the tetrahedra and the border of one block after the other.
class CoreCells {
public:
  CoreCells(const LatticeTree& tree, const CoreLeaves& core, const CoreSquares& squares);

  /// move_to() and make_here().
  void make(BlockIndex b);
  /// Sets the block, so that around(), is_of_shell() and is_deep() can be called. Makes no tetrahedra.
  void move_to(BlockIndex b);
  /// Makes the tetrahedra and the border of the block.
  void make_here();
  const LeafSurroundings& around() const { return _around; }
  bool is_of_shell(const HalfPlace& at) { return point(at).of_shell; }
  /// Whether a leaf of the block has no point of the shell.
  bool is_deep(int child);
  /// Of the block that was made last.
  std::span<const CoreCell> cells() const { return _cells; }
  std::span<const BorderTriangle> borders() const { return _borders; }

private:
  /// A lattice point at a half place of the block.
  struct Point {
    std::int64_t number;
    bool of_shell;
  };
  const Point& point(const HalfPlace& at);
  /// A side of a core leaf. sign: -1 for the lower side along the axis, 1 for the upper one.
  struct Side {
    int child;
    HalfPlace leaf;
    int axis, sign;

    int first_axis() const { return (axis + 1) % 3; }
    int second_axis() const { return (axis + 2) % 3; }
  };
  void make_side(const Side& side);
  void take_square(const Side& side, int first, int second, int step);
  void cover_square(const Side& side, const Leaf& other, bool counts_both);
  void surround_axis(const Side& side, const Leaf& other);
  void add_cell(int child, const std::array<const Point*, 4>& points);

  const CoreLeaves& _core;
  const CoreSquares& _squares;
  LeafSurroundings _around;
  std::array<Point, 125> _points;
  std::array<std::uint8_t, 125> _known{};
  std::array<Point, 8> _square;  // in the order of square_places
  SquarePattern _pattern = 0;    // of _square
  std::vector<CoreCell> _cells;
  std::vector<BorderTriangle> _borders;
};

}  // namespace aeroloom::volume
