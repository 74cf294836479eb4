/// From the blocks that ranks have to the problems that zones are.
#pragma once

#include "mesh/data/piece.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "parallel/communication/communicator.hpp"
#include "volume/filling/owned_cells.hpp"
#include "volume/lattice/lattice.hpp"
#include "volume/zones/shell.hpp"

#include <vector>

namespace aeroloom::volume {

/// All that a zone knows: what TetGen gets, and what the mesh piece will need.
struct ZoneInput {
  ZoneIndex zone = no_zone;
  ZoneProblem problem;
  std::vector<mesh::SharedVertexKey>
      vertex_keys;  ///< per point, ascending: number in the surface, then lattice points
  mesh::GlobalIndex surface_vertices = 0;     ///< before the first lattice point
  std::vector<LeafNumber> leaves;             ///< per point: that it belongs to
  std::vector<mesh::CadDimension> dimension;  ///< per surface point
  std::vector<std::int32_t> entity;           ///< per surface point
  std::vector<std::int32_t> face, patch;      ///< per triangle
  std::vector<LeafNumber> border_leaves;      ///< per triangle of the core's border: the core leaf beside it
};

/// The points, triangles and leaves that a rank sends to zones.
struct SendPlan {
  struct OfBlock {
    ZoneIndex zone;
    BlockIndex block;
    std::uint64_t points;  ///< of the block, a bit each
    std::uint8_t leaves;   ///< whose border triangles it may know, a bit each
  };
  struct Triangle {
    ZoneIndex zone;
    std::int32_t triangle;
  };
  std::vector<OfBlock> blocks;  ///< by zone, then block
  std::vector<Triangle> triangles;
  std::vector<parallel::Rank> ranks;  ///< per zone: where to
};

/// Sends what zones know to the ranks that fill them: points, triangles, and the triangles of the core's
/// border at its points. Returns the zones of this rank, by number. Collective.
std::vector<ZoneInput> gather_zone_inputs(const Lattice& lattice, const Shell& shell, const SendPlan& plan);

}  // namespace aeroloom::volume
