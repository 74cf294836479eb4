/// Which region the blocks lie in that the surface does not meet.
#pragma once

#include "volume/lattice/lattice.hpp"
#include "volume/lattice/near_surface.hpp"

#include <optional>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// Blocks that the surface does not separate and that are seen in different regions: the surface is not
/// closed, or intersects itself. The place is one of those that fewest places agree with.
struct Contradiction {
  BlockNumber set = 0;  ///< of blocks, by the lowest of them
  geometry::Vec3 place;
  mesh::GlobalIndex triangle = 0;  ///< of the surface mesh, nearest to the place
  mesh::RegionId seen = mesh::no_region, elsewhere = mesh::no_region;

  static constexpr auto fields() {
    return std::tuple(&Contradiction::set, &Contradiction::place, &Contradiction::triangle,
                      &Contradiction::seen, &Contradiction::elsewhere);
  }
};

struct BlockRegions {
  /// Of this rank's blocks: mesh::no_region outside of all, and also where the surface meets it: there each
  /// point is asked for itself.
  std::vector<mesh::RegionId> of_block;
  std::optional<Contradiction> contradiction;  ///< when there is one, the regions are not to be used
};

/// Blocks that share a face are of one region; all places where such a set touches a block that the surface
/// meets are looked at, each by the rank that has that block. What is found does not depend on who has which.
/// `surface` has the
/// triangles near this rank's blocks. Collective.
BlockRegions find_block_regions(const Lattice& lattice, std::span<const SurfaceTriangle> triangles,
                                const NearSurface& surface);

}  // namespace aeroloom::volume
