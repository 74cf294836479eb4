/// Seeds of a size field, and a tree that finds the smallest size that any seed allows at a point. A seed is
/// an octree cell in which a source asks for a size (docs/sizing.md).
#pragma once

#include "parallel/communication/node_array.hpp"
#include "sizing/field/subtrees.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// A cube or a point of the finest grid in which a size is asked for.
struct SizeSeed {
  GridPoint low;
  std::uint32_t edge = 0;  ///< in finest cells, a power of two; 0: the point alone
  double size = 0;
};

/// The seeds of all ranks, held once on each node.
class SharedSeeds {
public:
  SharedSeeds() = default;
  /// Each rank gives the seeds in its own subtrees. Collective.
  SharedSeeds(const Subtrees& subtrees, const std::vector<SizeSeed>& own);

  struct Keyed {
    std::uint64_t key;  ///< of the low corner
    SizeSeed seed;
  };
  const parallel::Communicator& communicator() const { return _communicator; }
  /// Adds the seeds of a rank.
  void append(parallel::Rank rank, std::vector<Keyed>& seeds) const;

private:
  static constexpr std::uint8_t of_point = 255;

  parallel::Communicator _communicator;
  std::vector<std::size_t> _firsts;           // per rank, and the end
  parallel::NodeArray<std::uint64_t> _keys;   // of their low corners
  parallel::NodeArray<std::uint8_t> _levels;  // a cube of half the grid's edge has 1
  parallel::NodeArray<double> _sizes;
};

/// Up to eight neighbours along the Morton curve, seeds or groups: their boxes and the smallest size in each.
/// Sizes are rounded down. Coordinates of the grid are exact in single precision.
struct SeedGroup {
  static constexpr int most = 8;
  std::array<std::array<float, most>, 3> low, high;  ///< by axis
  std::array<float, most> size;                      ///< infinite where there is no neighbour
  std::uint32_t first = 0;                           ///< number of the first neighbour

  static constexpr auto fields() {
    return std::tuple(&SeedGroup::low, &SeedGroup::high, &SeedGroup::size, &SeedGroup::first);
  }
  SeedGroup() = default;
  explicit SeedGroup(std::size_t number);
  void put(std::size_t i, const SizeSeed& seed);
  void put(std::size_t i, const SeedGroup& below);
};

/// Finds the least of size + slope * distance over all seeds at a point. This is the lower envelope of cones.
/// Up to eight neighbours along the Morton curve form a group, up to eight groups form a larger one, and so
/// on. The search skips a group if its smallest size at its nearest point is too much. The answer is the
/// exact minimum, to the last bit, in whatever order the tree is searched. Held once on each node.
class SeedTree {
public:
  SeedTree() = default;
  /// From one or several lists of seeds. `slope`: growth of the size for each finest cell. Collective.
  SeedTree(std::initializer_list<const SharedSeeds*> lists, double slope);

  /// The least size that any seed allows at a point, at most `bound`. `near`: the seed that won at the last
  /// point, -1 for none. It makes the search fast at points close together, and does not change the result.
  double cheapest(GridPoint p, double bound, std::int32_t& near) const;
  /// Whether any seed allows less than `bound` at a point.
  bool offers_less(GridPoint p, double bound) const;

private:
  using Group = SeedGroup;
  static constexpr int group = SeedGroup::most;
  struct Best {
    double size;
    std::int32_t seed;
  };

  struct Point {
    float x, y, z;
  };
  static Point point(GridPoint p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  }
  double offer(std::size_t seed, const Point& p) const;
  /// Lowers `best` to the least below a group of a level. With `any` the search ends at the first lower size.
  template <bool any>
  bool search(std::size_t level, std::size_t number, const Point& p, Best& best) const;

  struct Layer;
  struct PartOfRank;
  static Layer lowest_layer(const std::vector<SharedSeeds::Keyed>& seeds);
  static Layer layer_above(const Layer& below);

  /// Level 0: groups of seeds along the Morton curve. Each further level: groups of groups, up to one.
  std::vector<parallel::NodeArray<Group>> _levels;
  parallel::NodeArray<double> _sizes;  // of the seeds
  double _slope = 0, _steps_per_size = 0;
};

}  // namespace aeroloom::sizing
