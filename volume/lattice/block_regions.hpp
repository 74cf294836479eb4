/// The regions of the blocks that the surface does not meet.
#pragma once

#include "volume/lattice/lattice.hpp"
#include "volume/lattice/local_surface.hpp"

#include <optional>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// A connected set of free blocks that was found in different regions: the surface has a gap or intersects
/// itself. The place is from the region that was found at the fewest places.
struct Contradiction {
  BlockNumber set = 0;  ///< of blocks: the lowest number among them
  geometry::Vec3 place;
  mesh::GlobalIndex triangle = 0;  ///< of the surface mesh: the nearest one to the place
  mesh::RegionId seen = mesh::no_region, elsewhere = mesh::no_region;  ///< at the place, at most others
};

struct BlockRegions {
  /// Per own block. mesh::no_region: outside all regions, or met by the surface.
  std::vector<mesh::RegionId> of_block;
  std::optional<Contradiction> contradiction;  ///< if there is one, the regions are invalid
};

/// Free blocks, those that no triangle meets, are in one region if they are connected over faces. The region
/// is found at all faces between free and other blocks, by the owner of the other block. The result does not
/// depend on the partition. `triangles` and `surface` are the triangles within the search radii of this
/// rank's blocks. Collective.
BlockRegions find_block_regions(const Lattice& lattice, std::span<const SurfaceTriangle> triangles,
                                const LocalSurface& surface);

}  // namespace aeroloom::volume
