/// From a filled zone to pieces of the mesh, and the faces by which zones must fit together.
#pragma once

#include "mesh/data/distributed_mesh.hpp"
#include "volume/filling/zone_in_child.hpp"
#include "volume/filling/zone_inputs.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace aeroloom::volume {

/// A face of a zone's cell over which another zone's cell must be.
struct ZoneFace {
  std::array<mesh::SharedVertexKey, 3> vertices;  ///< ascending
  std::array<LeafNumber, 3> leaves;               ///< of each vertex; -1 of one that TetGen added
  ZoneIndex zone;
  mesh::RegionId region;
  std::int32_t
      odd;  ///< 1 where its orientation, seen from outside of the cell, is that of the descending vertices

  static constexpr auto fields() {
    return std::tuple(&ZoneFace::vertices, &ZoneFace::leaves, &ZoneFace::zone, &ZoneFace::region,
                      &ZoneFace::odd);
  }
};

/// A core leaf beside a triangle of the border that a zone's mesh does not have.
struct DemotedLeaf {
  LeafNumber leaf;
  ZoneIndex zone;
  static constexpr auto fields() { return std::tuple(&DemotedLeaf::leaf, &DemotedLeaf::zone); }
};

/// Where a piece meets the core.
struct CoreSide {
  mesh::LocalIndex first_lattice = 0;  ///< the first vertex of the lattice
  std::vector<std::int64_t> lattice;   ///< running numbers of those, ascending
  std::vector<LocalTriangle> borders;  ///< faces of its cells on the core's border
};

/// A zone's part of the mesh.
struct ZoneResult {
  ZoneIndex zone = no_zone;
  std::vector<mesh::Piece> pieces;   ///< by region; ids are those of regions so far
  std::vector<CoreSide> core_sides;  ///< per piece, until the core's cells have come
  std::vector<ZoneFace> faces;
  std::int64_t steiner_points = 0;
  std::int64_t tetrahedra = 0;
};

/// The mesh of the zones' pieces, by zone, then region, and of the core's after them, whose ids are those of
/// their ranges. What is said of patches, faces and regions is the surface's. Collective.
mesh::DistributedMesh assemble_mesh(const mesh::DistributedMesh& surface,
                                    std::map<ZoneIndex, ZoneResult>& results, std::vector<mesh::Piece> core,
                                    ZoneIndex zones);

/// With `surface_numbers`, vertices get their numbers in the surface mesh.
ZoneResult make_pieces(const ZoneInput& input, const ZoneFilling& filling, bool surface_numbers = false);

}  // namespace aeroloom::volume
