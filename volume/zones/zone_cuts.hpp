/// Planes that divide space into zones of equal load.
#pragma once

#include "volume/core/core_border.hpp"
#include "volume/lattice/block_points.hpp"
#include "volume/lattice/lattice_tree.hpp"
#include "volume/lattice/surface_triangles.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::volume {

using ZoneIndex = std::int32_t;
inline constexpr ZoneIndex no_zone = -1;

/// Expected tetrahedra of the shell per lattice point and per surface triangle, and the reduction per border
/// triangle of the core: half a point stands there, and half of its tetrahedra are in the core.
inline constexpr double tetrahedra_per_point = 5.75, tetrahedra_per_triangle = 2,
                        fewer_per_border = 0.5 * tetrahedra_per_point - 2;

/// Expected tetrahedra of the shell, in eighths, so that sums are exact.
using Load = std::int64_t;
inline constexpr int loads_per_tetrahedron = 8;
inline double tetrahedra_of(Load load) {
  return static_cast<double>(load) / loads_per_tetrahedron;
}
/// The load of a block, from its shell points, its surface triangles and its triangles of the core's border.
inline Load load_of(std::int64_t points, std::int64_t triangles, std::int64_t borders) {
  constexpr auto per_point = static_cast<Load>(loads_per_tetrahedron * tetrahedra_per_point),
                 per_triangle = static_cast<Load>(loads_per_tetrahedron * tetrahedra_per_triangle),
                 per_border = static_cast<Load>(loads_per_tetrahedron * fewer_per_border);
  return std::max<Load>(0, per_point * points + per_triangle * triangles - per_border * borders);
}

/// A block or an ancestor of blocks, with the sums over its blocks.
struct CoarseCell {
  std::uint64_t key;
  std::int32_t level;
  std::int32_t is_block;
  Load load;
  Load edges;  ///< sum of load times block edge, in finest cells
};

/// The largest cubes with a load of at most `most`, and blocks with more, in Morton order. Cubes without load
/// are left out. `loads` has one per own block. The same on any number of ranks. Collective.
std::vector<CoarseCell> coarsen(const LatticeTree& tree, std::span<const Load> loads, Load most);

/// Divides space into zones by planes. The same on every rank.
class ZoneCuts {
public:
  /// The number of coarse cells per zone, about. Chosen, not measured.
  static constexpr Load cells_per_zone = 128;

  /// Recursive bisection into zones of equal load. Of the planes across the three axes it takes the one with
  /// the least load in the blocks beside it. The load of a cell counts as spread evenly.
  ZoneCuts(std::span<const CoarseCell> cells, ZoneIndex count);

  ZoneIndex count() const { return _count; }
  /// The zone of a block: the one that contains its centre.
  ZoneIndex zone_of(const GridCube& block) const;
  /// The zone of all blocks that a cube can contain; no_zone if they can be in several.
  ZoneIndex zone_of_all(const GridCube& cube) const;
  /// Calls visit(zone) for all zones that blocks in a cube can belong to.
  template <class Visit>
  void for_each_zone_in(const GridCube& cube, const Visit& visit) const {
    zones_below(_cuts.data(), 0, _count, cube, visit);
  }

private:
  struct Part;
  struct Cut {
    int axis;
    std::uint32_t twice_place;
  };
  void divide(std::vector<Part> parts, ZoneIndex count);
  /// The sides of a cut on which centres of blocks in a cube can lie.
  struct Sides {
    bool below, above;
  };
  static Sides sides_of(const Cut& cut, const GridCube& cube) {
    const std::uint32_t low = cut.axis == 0 ? cube.low.x : cut.axis == 1 ? cube.low.y : cube.low.z;
    return {2 * low<cut.twice_place, 2 * (low + cube.edge())> cut.twice_place};
  }
  template <class Visit>
  static void zones_below(const Cut* cut, ZoneIndex first, ZoneIndex count, const GridCube& cube,
                          const Visit& visit) {
    if (count == 1) return visit(first);
    const ZoneIndex half = count / 2;
    const Sides sides = sides_of(*cut, cube);
    if (sides.below) zones_below(cut + 1, first, half, cube, visit);
    if (sides.above) zones_below(cut + half, first + half, count - half, cube, visit);
  }

  ZoneIndex _count;
  std::vector<Cut> _cuts;  // a tree in preorder: cut into n / 2 and n - n / 2 zones, their cuts
};

}  // namespace aeroloom::volume
