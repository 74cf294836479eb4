/// The invariants of a mesh (docs/architecture.md), checked over all pieces and ranks.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <string>
#include <vector>

namespace aeroloom::mesh {

/// Violations of the invariants of a mesh, the same on every rank. Each violation is a sentence with a count,
/// and the piece and coordinates of the first offender by global number.
struct ValidityReport {
  std::vector<std::string> violations;
  double volume = 0;          ///< of all cells (volume meshes), or enclosed by the surface (triangles)
  double surface_volume = 0;  ///< by the divergence integral over the boundary faces
  std::vector<double> region_volumes;  ///< `volume` by region
  bool valid() const { return violations.empty(); }
};

/// Checks a volume mesh of any cells: positive volumes (tetrahedra exactly; pyramids, prisms and hexahedra by
/// their bilinear volume, and exactly at their corners), every face in one cell plus one boundary face of an
/// outer CAD face or in two cells, and there with one boundary face of an inner CAD face wherever the cells'
/// regions differ and on baffles alone where not, boundary faces between the regions of their CAD face, a
/// closed boundary around each region, no orphan vertices, identical coordinates of shared vertices, equal
/// volumes of each region (1e-10), a patch and a CAD face for every boundary face, and, when `surface` is
/// given, that the boundary triangles are exactly its triangles (by coordinate bits). Memory per rank is
/// bounded by its share of the faces. Throws CollectiveError when arrays or numbering do not fit the mesh.
/// Collective.
ValidityReport check_volume_mesh(const NumberedMesh& mesh, const DistributedMesh* surface);

/// Checks a surface mesh: around each region every edge in exactly two triangles with opposite directions (an
/// even number, half each way, where sheets touch), no degenerate or repeated triangle, no orphan vertices,
/// positive enclosed volume of each region, a patch and a CAD face for every triangle. Throws as
/// check_volume_mesh. Collective.
ValidityReport check_surface_mesh(const NumberedMesh& mesh);

}  // namespace aeroloom::mesh
