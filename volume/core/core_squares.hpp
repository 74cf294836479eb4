/// How the squares between leaves of the lattice are cut into triangles.
#pragma once

#include "volume/lattice/lattice_frame.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// A square across `axis`, seen against it: its corners and the middles of its edges in cyclic order, in
/// halves of an edge along the next axis and the one after that.
inline constexpr int square_places[8][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
/// Which middles of edges have points: a bit each, in cyclic order.
using SquarePattern = unsigned;
inline constexpr SquarePattern square_patterns = 16;

/// The Delaunay triangulations of the points of a square in its plane. The shear of the lattice makes them
/// unique and the same for all squares across one axis; perturbations up to a hundredth of an edge do not
/// change them. Immutable.
class CoreSquares {
public:
  explicit CoreSquares(const LatticeFrame& frame);

  /// By places in cyclic order, counter-clockwise as the square is seen.
  using Triangle = std::array<std::uint8_t, 3>;
  std::span<const Triangle> triangles(int axis, SquarePattern pattern) const {
    return _triangles[axis][pattern];
  }

private:
  std::array<std::array<std::vector<Triangle>, square_patterns>, 3> _triangles;
};

}  // namespace aeroloom::volume
