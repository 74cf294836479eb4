/// Which zones know what lies in a block.
#pragma once

#include "volume/lattice/lattice.hpp"
#include "volume/zones/zones.hpp"

#include <span>
#include <vector>

namespace aeroloom::volume {

/// The largest size in a block and next to it: the mean edge of the lattice, or the longest edge of the
/// surface.
double largest_size_around(const Lattice& lattice, BlockIndex b);

/// A zone that has leaves near a block.
struct NearZone {
  ZoneIndex zone;
  double radius;                   ///< how near things in the block have to be, in the grid
  std::span<const GridBox> boxes;  ///< where the zone lies

  bool knows(const GridBox& box) const;
};

/// A zone knows what is nearer to its leaves than `width` times the largest size found in the block of what
/// is asked for or next to it; a size is the mean edge of the lattice or the longest edge of the surface. A
/// halo in each point's own size would fail where sizes jump. Where blocks of several zones are far smaller
/// than that block, all of them are there.
class ZonesAround {
public:
  /// Levels by which blocks are looked at as one cube. Chosen, not measured.
  static constexpr int finer_levels = 3;
  /// How far from a block leaves of zones matter to what lies in it, in the grid. Triangles count to the
  /// block that their centre lies in, so that they may stick out of it.
  static double search_radius(const Lattice& lattice, BlockIndex b, double width) {
    return lattice.frame.grid_distance(width * largest_size_around(lattice, b) +
                                       lattice.table.longest_edge[b]);
  }

  /// `widths` are those of zones. Refers to what it is made from.
  ZonesAround(const Lattice& lattice, const Zones& zones, std::span<const double> widths);

  /// To a block of this rank.
  void move_to(BlockIndex b);
  /// Zones that may know something in the block, by number; those that have leaves of it among them.
  std::span<const NearZone> zones() const { return _near; }

private:
  struct ZoneBox {
    ZoneIndex zone;
    GridBox box;
  };
  void find_places(const GridCube& cube, const GridBox& around, int finest);

  const Lattice& _lattice;
  const Zones& _zones;
  std::span<const double> _widths;
  double _widest;
  std::vector<ZoneBox> _places;
  std::vector<GridBox> _boxes;
  std::vector<NearZone> _near;
};

/// The cubes of blocks across the borders of zones that halos of a width are told by (ZonesAround).
/// Collective.
std::vector<GridCube> fetch_cut_ghosts(const Lattice& lattice, const ZoneCuts& cuts, double width);

}  // namespace aeroloom::volume
