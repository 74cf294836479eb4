/// Regions whose space falls into several parts that no inner face of a cell joins, seen on the surface.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <vector>

namespace aeroloom::mesh {

/// A part of a region that meets the others in edges and vertices at most.
struct Enclosure {
  RegionId region = 0;
  double volume = 0;       ///< without the voids in it, up to rounding
  geometry::Vec3 place{};  ///< the middle of its box
};

/// The chambers of each region that has several, the largest of a region first; the same on every rank.
/// Around a region, triangles are of one shell where they follow each other around an edge with the region
/// between them. Each shell that encloses a positive volume is the outside of one chamber. Shells of a piece
/// are found on its rank; what is gathered has a row for each of them, and one for each pair that meets.
/// The surface is valid (check_surface_mesh()). Collective.
std::vector<Enclosure> find_enclosures(const NumberedMesh& surface);

}  // namespace aeroloom::mesh
