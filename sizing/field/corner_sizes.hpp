/// Sizes at the corners of an octree's leaves, those that siblings share held once.
#pragma once

#include "sizing/field/octree.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::sizing {

/// Leaves of one size that fill a cube above them, one, eight or 64, are a family: its corners are held once,
/// 8, 27 or 125 of them, one family after another along the curve. That makes 11 bytes a leaf where 32 would
/// be. Which leaves are a family follows from the leaves.
class CornerSizes {
public:
  /// The sizes at the corners of one leaf: corner (i,j,k), each 0 or 1, is at i + j*y + k*z.
  struct Cube {
    const float* sizes;
    std::size_t y, z;

    float operator()(int corner) const {
      return sizes[(corner & 1) + (corner >> 1 & 1) * y + (corner >> 2 & 1) * z];
    }
  };

  CornerSizes() = default;
  /// From what pack() gives for a rank's part of the leaves, part_of(). Held once per node. Collective.
  CornerSizes(const Octree& octree, std::vector<float> own);
  /// From the packed sizes of all leaves, the same on every rank. Throws std::logic_error where there are not
  /// as many as the leaves need. Held once per node. Collective.
  static CornerSizes unpacked(const Octree& octree, parallel::NodeArray<float> packed);

  /// The leaves that a rank finds sizes for: about as many for each, families together.
  static IndexRange part_of(const Octree& octree, parallel::Rank rank);
  /// The sizes at corners of a range of leaves, (leaves,8) with corners in Morton order, as they are held.
  static std::vector<float> pack(CellSpans leaves, IndexRange range, std::span<const float> corner_sizes);

  Cube of_leaf(std::size_t leaf) const {
    const std::uint64_t place = _places[leaf];
    const std::size_t along = corners_along(static_cast<int>(place & ((1 << place_shift) - 1)));
    return {_packed.data() + (place >> place_shift), along, along * along};
  }
  const parallel::NodeArray<float>& packed() const { return _packed; }

  /// Levels from a family's leaves up to the cube that they fill, at most.
  static constexpr int most_generations = 2;
  /// On an edge of the cube.
  static constexpr std::size_t corners_along(int generations) { return (std::size_t{1} << generations) + 1; }

private:
  /// Writes the places of a range of leaves whose packed sizes begin with that one; returns where they end.
  static std::uint64_t write_places(CellSpans leaves, IndexRange range, std::uint64_t begin,
                                    std::span<std::uint64_t> to);

  static constexpr int place_shift = 2;
  parallel::NodeArray<float> _packed;
  /// Per leaf where its first corner is among the packed sizes; in the last bits the generations.
  parallel::NodeArray<std::uint64_t> _places;
};

}  // namespace aeroloom::sizing
