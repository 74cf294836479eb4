/// Wall edges whose lateral faces lie on another CAD face, because layers end there.
#pragma once

#include "layers/columns.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// The lateral face over an edge of a wall triangle belongs to this CAD face and patch.
struct LateralEdge {
  mesh::PieceId piece;     ///< of the wall
  std::int32_t half_edge;  ///< 3 triangle + the corner that the edge starts from
  std::int32_t face, patch;
};

/// Finds the edges between a triangle with layers and one of a patch without, if an end has a column. Returns
/// those of this rank's pieces, by piece and half-edge. Collective.
std::vector<LateralEdge> find_lateral_edges(const mesh::NumberedMesh& wall, const Columns& columns);

}  // namespace aeroloom::layers
