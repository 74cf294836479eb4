/// Makes the pieces of the mesh from filled zones, and the faces where zones must fit together.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "volume/filling/zone_in_child.hpp"
#include "volume/filling/zone_inputs.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <vector>

namespace aeroloom::volume {

/// A face of a zone's cell that a cell of another zone must share.
struct ZoneFace {
  std::array<mesh::SharedVertexKey, 3> vertices;  ///< ascending
  std::array<LeafNumber, 3> leaves;               ///< per vertex; -1 if TetGen added it
  ZoneIndex zone;
  mesh::RegionId region;
  std::int32_t odd;  ///< 1 if the vertices turn clockwise seen from outside the cell, else 0
};

/// A core leaf that becomes shell, because a border triangle beside it is missing in the mesh of a zone.
struct DemotedLeaf {
  LeafNumber leaf;
  ZoneIndex zone;
};

/// Where a piece of a zone meets the core.
struct CoreSide {
  mesh::LocalIndex first_lattice = 0;  ///< the first vertex that is a lattice point
  std::vector<std::int64_t> lattice;   ///< numbers of lattice points among the vertices, ascending
  std::vector<LocalTriangle> borders;  ///< faces of its cells on the border
};

/// The result of filling a zone.
struct ZoneResult {
  ZoneIndex zone = no_zone;
  std::vector<mesh::Piece> pieces;   ///< by region; the id is the region until assemble_mesh()
  std::vector<CoreSide> core_sides;  ///< per piece; empty after make_core()
  std::vector<ZoneFace> faces;
  std::int64_t steiner_points = 0;
  std::int64_t tetrahedra = 0;
};

/// The mesh of all pieces: those of zones by zone and region, then those of the core by range and region.
/// Patches, faces and regions are those of the surface. Collective.
mesh::DistributedMesh assemble_mesh(const mesh::DistributedMesh& surface,
                                    std::map<ZoneIndex, ZoneResult>& results, std::vector<mesh::Piece> core,
                                    ZoneIndex zones);

/// With `surface_numbers`, vertices get their numbers in the surface mesh.
ZoneResult make_pieces(const ZoneInput& input, const ZoneFilling& filling, bool surface_numbers = false);

}  // namespace aeroloom::volume
