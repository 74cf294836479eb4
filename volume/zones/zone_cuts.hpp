/// Where space is cut into zones of equal load.
#pragma once

#include "volume/core/core_border.hpp"
#include "volume/lattice/block_points.hpp"
#include "volume/lattice/lattice_tree.hpp"
#include "volume/lattice/surface_near_blocks.hpp"

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

using ZoneIndex = std::int32_t;
inline constexpr ZoneIndex no_zone = -1;

/// Tetrahedra of the shell around a lattice point, and next to the surface, per triangle. For each triangle
/// of the core's border there are fewer: half a point stands there, half of whose tetrahedra are the core's.
inline constexpr double tetrahedra_per_point = 5.75, tetrahedra_per_triangle = 2,
                        fewer_per_border = 0.5 * tetrahedra_per_point - 2;

/// Tetrahedra of the shell that are expected, in eighths, so that sums are exact.
using Load = std::int64_t;
inline constexpr int loads_per_tetrahedron = 8;
inline double tetrahedra_of(Load load) {
  return static_cast<double>(load) / loads_per_tetrahedron;
}
/// Of a block with so many points of the shell, triangles of the surface and of the core's border.
inline Load load_of(std::int64_t points, std::int64_t triangles, std::int64_t borders) {
  constexpr auto per_point = static_cast<Load>(loads_per_tetrahedron * tetrahedra_per_point),
                 per_triangle = static_cast<Load>(loads_per_tetrahedron * tetrahedra_per_triangle),
                 per_border = static_cast<Load>(loads_per_tetrahedron * fewer_per_border);
  return std::max<Load>(0, per_point * points + per_triangle * triangles - per_border * borders);
}

/// A cube with what its blocks have together: an ancestor of blocks, or a block.
struct CoarseCell {
  std::uint64_t key;
  std::int32_t level;
  std::int32_t is_block;
  Load load;
  Load edges;  ///< each block's load times its edge, in finest cells

  static constexpr auto fields() {
    return std::tuple(&CoarseCell::key, &CoarseCell::level, &CoarseCell::is_block, &CoarseCell::load,
                      &CoarseCell::edges);
  }
};

/// The largest cubes whose loads are at most `most`, and blocks with more, along the curve, without those
/// that have no load. `loads` are those of this rank's blocks. The same on any number of
/// ranks. Collective.
std::vector<CoarseCell> coarsen(const LatticeTree& tree, std::span<const Load> loads, Load most);

/// Planes that cut space into zones. The same on every rank: a plane for each zone.
class ZoneCuts {
public:
  /// Cells that a zone is made of, about. Chosen, not measured.
  static constexpr Load cells_per_zone = 128;

  /// Zones of equal load by recursive bisection: always across the axis where the two halves have least in
  /// common, in expected tetrahedra of the blocks beside the cut. Loads are taken to be spread evenly within
  /// cells.
  ZoneCuts(std::span<const CoarseCell> cells, ZoneIndex count);

  ZoneIndex count() const { return _count; }
  /// The zone of a block: that of its middle.
  ZoneIndex zone_of(const GridCube& block) const;
  /// The zone of all blocks there may be in a cube, no_zone where they may be of several.
  ZoneIndex zone_of_all(const GridCube& cube) const;
  /// Calls visit(zone) for all zones that blocks in a cube may be of.
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
  /// On which sides of a cut middles of blocks in a cube may lie.
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
  std::vector<Cut> _cuts;  // of n zones: the cut between the n / 2 lower ones and the others, theirs after it
};

}  // namespace aeroloom::volume
