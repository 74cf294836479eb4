/// Sizes at the corners of the leaves of an octree. Corners that siblings have in common are held once.
#pragma once

#include "sizing/field/octree.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::sizing {

/// A family is 1, 8 or 64 leaves of one size that fill a cube. The 8, 27 or 125 corners of a family are held
/// once, one family after another along the Morton curve. This takes 11 bytes for each leaf instead of 32.
/// The leaves alone decide which of them form a family.
class CornerSizes {
public:
  /// The sizes at the corners of one leaf. Corner (i, j, k), each 0 or 1, is at i + j * y + k * z.
  struct Cube {
    const float* sizes;
    std::size_t y, z;

    float operator()(int corner) const {
      return sizes[(corner & 1) + (corner >> 1 & 1) * y + (corner >> 2 & 1) * z];
    }
  };

  CornerSizes() = default;
  /// From the packed sizes of all leaves, the same on every rank. Held once on each node. Collective. Throws
  /// std::logic_error where their number does not fit the leaves.
  CornerSizes(const Octree& octree, std::vector<float> own);
  /// From the packed sizes of all leaves, the same on every rank. Throws std::logic_error where there are not
  /// as many as the leaves need. Held once per node. Collective.
  static CornerSizes unpacked(const Octree& octree, parallel::NodeArray<float> packed);

  /// The leaves whose corners a rank finds the sizes of. Ranks have about as many each; no family is divided.
  static IndexRange part_of(const Octree& octree, parallel::Rank rank);
  /// Packs the sizes at the corners of a range of leaves, shape (leaves, 8), corners in Morton order.
  static std::vector<float> pack(CellSpans leaves, IndexRange range, std::span<const float> corner_sizes);

  Cube of_leaf(std::size_t leaf) const {
    const std::uint64_t place = _places[leaf];
    const std::size_t along = corners_along(static_cast<int>(place & ((1 << place_shift) - 1)));
    return {_packed.data() + (place >> place_shift), along, along * along};
  }
  const parallel::NodeArray<float>& packed() const { return _packed; }

  /// The most levels between the leaves of a family and the cube that they fill.
  static constexpr int most_generations = 2;
  /// Corners of a family along one edge of its cube.
  static constexpr std::size_t corners_along(int generations) { return (std::size_t{1} << generations) + 1; }

private:
  /// Writes where the sizes of a range of leaves stand, the first one at `begin`. Returns where they end.
  static std::uint64_t write_places(CellSpans leaves, IndexRange range, std::uint64_t begin,
                                    std::span<std::uint64_t> to);

  static constexpr int place_shift = 2;
  parallel::NodeArray<float> _packed;
  /// Of each leaf, the place of its first corner among the packed sizes; the last bits hold the generations.
  parallel::NodeArray<std::uint64_t> _places;
};

}  // namespace aeroloom::sizing
