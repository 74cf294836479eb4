/// Halos: the points and triangles around a zone that it is filled with too.
#pragma once

#include "volume/lattice/lattice.hpp"
#include "volume/zones/zones.hpp"

#include <span>
#include <vector>

namespace aeroloom::volume {

/// The largest size in a block and in all that touch it: the mean edge of the lattice, or the longest edge of
/// the surface.
double largest_size_around(const Lattice& lattice, BlockIndex b);

/// A zone whose halo may reach into a block.
struct HaloZone {
  ZoneIndex zone;
  double radius;                   ///< width of its halo in the block, in the grid
  std::span<const GridBox> boxes;  ///< boxes that contain the zone's leaves near the block

  /// Whether a box in the block is within the radius of the zone.
  bool reaches(const GridBox& box) const;
};

/// Finds the zones whose halos reach into a block. Points and triangles of a block are in the halo of a zone
/// if they are within `width` times largest_size_around() of its leaves. The size at the point alone would be
/// too small where sizes jump. A cube with far finer blocks counts as part of each zone that it may touch.
class ZonesAround {
public:
  /// Blocks finer than a block by more levels count as one cube. Chosen, not measured.
  static constexpr int finer_levels = 3;
  /// The distance from a block within which leaves of zones matter to it, in the grid. A triangle belongs to
  /// the block of its centre, and may extend beyond it.
  static double search_radius(const Lattice& lattice, BlockIndex b, double width) {
    return lattice.frame.grid_distance(width * largest_size_around(lattice, b) +
                                       lattice.table.longest_edge[b]);
  }

  /// `widths` has one per zone, in sizes. Refers to its arguments.
  ZonesAround(const Lattice& lattice, const Zones& zones, std::span<const double> widths);

  /// Finds the zones for a block of this rank.
  void move_to(BlockIndex b);
  /// The zones that have leaves in the block or may reach into it, by number.
  std::span<const HaloZone> zones() const { return _halos; }

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
  std::vector<HaloZone> _halos;
};

/// The cubes of blocks on planes between zones that ZonesAround needs for halos of a width. `width` is in
/// sizes. Collective.
std::vector<GridCube> fetch_cut_ghosts(const Lattice& lattice, const ZoneCuts& cuts, double width);

}  // namespace aeroloom::volume
