/// Collects the points and triangles of zones from the ranks that own the blocks.
#pragma once

#include "mesh/data/piece.hpp"
#include "mesh/data/shared_vertex_keys.hpp"
#include "parallel/communication/communicator.hpp"
#include "volume/filling/owned_cells.hpp"
#include "volume/lattice/lattice.hpp"
#include "volume/zones/shell.hpp"

#include <vector>

namespace aeroloom::volume {

/// The input of a zone, halo included: the problem for TetGen, and the data for the pieces of the mesh.
struct ZoneInput {
  ZoneIndex zone = no_zone;
  ZoneProblem problem;
  std::vector<mesh::SharedVertexKey> vertex_keys;  ///< per point, ascending
  mesh::GlobalIndex surface_vertices = 0;     ///< of the whole surface: the key of the first lattice point
  std::vector<LeafNumber> leaves;             ///< per point: the leaf it belongs to
  std::vector<mesh::CadDimension> dimension;  ///< per surface point
  std::vector<std::int32_t> entity;           ///< per surface point
  std::vector<std::int32_t> face, patch;      ///< per triangle
  std::vector<LeafNumber> border_leaves;      ///< per border triangle: the core leaf beside it
};

/// Which points, triangles and border triangles of this rank go to which zones.
struct SendPlan {
  struct OfBlock {
    ZoneIndex zone;
    BlockIndex block;
    std::uint64_t points;  ///< of the block, as bits
    std::uint8_t leaves;   ///< leaves whose border triangles are sent, as bits
  };
  struct Triangle {
    ZoneIndex zone;
    std::int32_t triangle;
  };
  std::vector<OfBlock> blocks;  ///< by zone, then block
  std::vector<Triangle> triangles;
  std::vector<parallel::Rank> ranks;  ///< per zone: the rank that fills it
};

/// Sends points, triangles and border triangles to the ranks that fill the zones. Returns the inputs of this
/// rank's zones, by number. Collective.
std::vector<ZoneInput> gather_zone_inputs(const Lattice& lattice, const Shell& shell, const SendPlan& plan);

}  // namespace aeroloom::volume
