/// Cubes that ask for sizes, searched for what counts at a point.
#pragma once

#include "parallel/communication/node_array.hpp"
#include "sizing/field/pages.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <tuple>
#include <vector>

namespace aeroloom::sizing {

/// A cube of the finest grid, or a point of it, in which a size is asked for.
struct SizeSeed {
  GridPoint low;
  std::uint32_t edge = 0;  ///< in finest cells, a power of two; 0: the point alone
  double size = 0;
};

/// Seeds of all ranks, held once per node.
class SharedSeeds {
public:
  SharedSeeds() = default;
  /// Each rank gives the seeds in its pages, which lie along the curve before those of higher ranks.
  /// Collective.
  SharedSeeds(const Pages& pages, const std::vector<SizeSeed>& own);

  struct Keyed {
    std::uint64_t key;  ///< of the low corner
    SizeSeed seed;
  };
  const parallel::Communicator& communicator() const { return _communicator; }
  /// Adds those of a rank.
  void append(parallel::Rank rank, std::vector<Keyed>& seeds) const;

private:
  static constexpr std::uint8_t of_point = 255;

  parallel::Communicator _communicator;
  std::vector<std::size_t> _firsts;           // per rank, and the end
  parallel::NodeArray<std::uint64_t> _keys;   // of their low corners
  parallel::NodeArray<std::uint8_t> _levels;  // a cube of half the grid's edge has 1
  parallel::NodeArray<double> _sizes;
};

/// The boxes of up to eight neighbours along the Morton curve, seeds or groups of them, and the smallest size
/// in each, rounded down; coordinates of the grid are exact in single precision.
struct SeedGroup {
  static constexpr int most = 8;
  std::array<std::array<float, most>, 3> low, high;  ///< by axis
  std::array<float, most> size;                      ///< infinite where there is no neighbour
  std::uint32_t first = 0;                           ///< number of the first of them

  static constexpr auto fields() {
    return std::tuple(&SeedGroup::low, &SeedGroup::high, &SeedGroup::size, &SeedGroup::first);
  }
  SeedGroup() = default;
  explicit SeedGroup(std::size_t number);
  void put(std::size_t i, const SizeSeed& seed);
  void put(std::size_t i, const SeedGroup& below);
};

/// The lower envelope of cones over seeds: at a point, the least of size + slope * distance over all seeds.
/// Up to eight neighbours along the Morton curve are a group, up to eight of those, and so on; a group is
/// passed by where even its smallest size at its nearest point would be too much. The answer is the exact
/// minimum, to the last bit, whatever order the search takes. Held once per node.
class SeedTree {
public:
  SeedTree() = default;
  /// Of the seeds in one or several lists; `slope` counts in size per finest cell. Collective.
  SeedTree(std::initializer_list<const SharedSeeds*> lists, double slope);

  /// The least offer at a point, `bound` where none is below it. `near` makes the search quick where the last
  /// point was close by: the seed whose offer won there, -1 none. The result does not depend on it.
  double cheapest(GridPoint p, double bound, std::int32_t& near) const;
  /// Whether a seed offers less than `bound` at a point.
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
  /// Lowers `best` to what lies below the group of a level; ends at the first lower offer where any will do.
  template <bool any>
  bool search(std::size_t level, std::size_t number, const Point& p, Best& best) const;

  struct Layer;
  struct PartOfRank;
  static Layer lowest_layer(const std::vector<SharedSeeds::Keyed>& seeds);
  static Layer layer_above(const Layer& below);

  /// The seeds along the Morton curve in groups; groups of those, and so on up to one.
  std::vector<parallel::NodeArray<Group>> _levels;
  parallel::NodeArray<double> _sizes;  // of the seeds
  double _slope = 0, _steps_per_size = 0;
};

}  // namespace aeroloom::sizing
