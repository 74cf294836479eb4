/// The triangulations of the squares between leaves of the lattice.
#pragma once

#include "volume/lattice/lattice_frame.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// The corners of a square and the middles of its edges, counter-clockwise if seen against the axis that is
/// normal to it: places along the next two axes, in half edges.
inline constexpr int square_places[8][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
/// Which middles of edges have points, as bits, in the order of square_places.
using SquarePattern = unsigned;
inline constexpr SquarePattern square_patterns = 16;

/// The Delaunay triangulations of the points of a square in its plane. The shear of the lattice makes them
/// unique, and the same for all squares normal to one axis. Perturbations of up to a hundredth of an edge do
/// not change them. Immutable.
class CoreSquares {
public:
  explicit CoreSquares(const LatticeFrame& frame);

  /// Indices into square_places, counter-clockwise.
  using Triangle = std::array<std::uint8_t, 3>;
  std::span<const Triangle> triangles(int axis, SquarePattern pattern) const {
    return _triangles[axis][pattern];
  }

private:
  std::array<std::array<std::vector<Triangle>, square_patterns>, 3> _triangles;
};

}  // namespace aeroloom::volume
