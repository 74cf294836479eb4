/// The region of points in large blocks, told by the triangles that meet these alone.
#pragma once

#include "volume/lattice/lattice.hpp"
#include "volume/lattice/near_surface.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::volume {

/// Looks from a point to triangles whose boxes meet its block: what lies between is in the block, or off it
/// by no more than the longest of their edges (SearchRadii::from_within), so nothing farther away matters.
/// Refers to all it is made from.
class WithinBlocks {
public:
  WithinBlocks(const Lattice& lattice, const NearSurface& surface) : _lattice(lattice), _surface(surface) {}

  struct Seen {
    mesh::RegionId region;
    std::int32_t triangle;  ///< that was looked at
  };
  /// At a point of the block, off the surface. Nothing where all triangles are seen edge-on.
  std::optional<Seen> look(BlockIndex b, geometry::Vec3 p);

private:
  struct Target {
    std::int32_t triangle;
    geometry::Vec3 center;
  };
  void find_targets(BlockIndex b);

  const Lattice& _lattice;
  const NearSurface& _surface;
  BlockIndex _block = -1;  // whose targets these are
  std::vector<Target> _targets;
};

}  // namespace aeroloom::volume
