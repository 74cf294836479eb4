/// Finds the region of points in a large block from the triangles that meet the block alone.
#pragma once

#include "volume/lattice/lattice.hpp"
#include "volume/lattice/local_surface.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace aeroloom::volume {

/// Follows the line from a point to the centre of a triangle whose box meets the block. The line leaves the
/// block by no more than the longest edge of these triangles, so no other triangle matters. Refers to its
/// arguments.
class RegionInBlock {
public:
  RegionInBlock(const Lattice& lattice, const LocalSurface& surface) : _lattice(lattice), _surface(surface) {}

  struct Found {
    mesh::RegionId region;
    std::int32_t triangle;  ///< at the end of the line
  };
  /// For a point of the block, off the surface. Nothing if the point lies in the planes of all triangles.
  std::optional<Found> find(BlockIndex b, geometry::Vec3 p);

private:
  struct Target {
    std::int32_t triangle;
    geometry::Vec3 center;
  };
  void find_targets(BlockIndex b);

  const Lattice& _lattice;
  const LocalSurface& _surface;
  BlockIndex _block = -1;  // that the targets belong to
  std::vector<Target> _targets;
};

}  // namespace aeroloom::volume
