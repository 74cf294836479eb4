/// The tetrahedra of the core, and the triangles of its border, block by block.
///
/// Three cases. Between two core leaves of one size: a tetrahedron for each part of an edge of their square,
/// around the line between their centres; the same across a plain square to a leaf of the shell that has its
/// centre, and the border goes around that leaf's pyramid. Between unequal ones: the pyramid of each centre
/// over the finer square, cut in two, by the same diagonal on both sides. Towards the shell: the pyramid over
/// the finer square, cut with the points that stand on its edges.
#pragma once

#include "volume/core/core_leaves.hpp"
#include "volume/core/core_squares.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// A tetrahedron of the core, positive volume in VTK's order.
struct CoreCell {
  std::array<std::int64_t, 4> points;  ///< running numbers of the lattice
  std::uint8_t child;                  ///< the leaf it is counted to
  std::uint8_t of_shell;               ///< points that belong to the shell too, a bit each
};

/// A triangle between core and shell, counter-clockwise seen from the core.
struct BorderTriangle {
  std::array<std::int64_t, 3> points;
  std::uint8_t child;  ///< the core leaf beside it
};

/// Makes those of this rank's blocks, one after the other.
class CoreCells {
public:
  CoreCells(const LatticeTree& tree, const CoreLeaves& core, const CoreSquares& squares);

  void make(BlockIndex b);
  /// Moves to a block and makes nothing there; what is asked for is known of it.
  void move_to(BlockIndex b);
  void make_here();
  const LeafSurroundings& around() const { return _around; }
  bool is_of_shell(const HalfPlace& at) { return point(at).of_shell; }
  /// Whether no point of the shell stands on a leaf of the block.
  bool is_deep(int child);
  /// Of the block made last.
  std::span<const CoreCell> cells() const { return _cells; }
  std::span<const BorderTriangle> borders() const { return _borders; }

private:
  /// A point of the lattice at a half place of the block.
  struct Point {
    std::int64_t number;
    bool of_shell;
  };
  const Point& point(const HalfPlace& at);
  /// A side of a core leaf; sign -1 the lower one along the axis, 1 the higher.
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
  SquarePattern _pattern = 0;    // of it
  std::vector<CoreCell> _cells;
  std::vector<BorderTriangle> _borders;
};

}  // namespace aeroloom::volume
