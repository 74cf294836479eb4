/// Where layers end on another CAD face: edges of the wall whose lateral faces are boundary of that face.
#pragma once

#include "layers/columns.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::layers {

/// What lies over an edge of a triangle of the wall belongs to this face and patch.
struct LateralEdge {
  mesh::PieceId piece;     ///< of the wall
  std::int32_t half_edge;  ///< 3 triangle + corner that it starts from
  std::int32_t face, patch;

  static constexpr auto fields() {
    return std::tuple(&LateralEdge::piece, &LateralEdge::half_edge, &LateralEdge::face, &LateralEdge::patch);
  }
};

/// The edges between a triangle that bears layers and one of a patch that bears none, with a column at an
/// end. Those of the pieces on this rank, by piece and half-edge. Collective.
std::vector<LateralEdge> find_lateral_edges(const mesh::NumberedMesh& wall, const Columns& columns);

}  // namespace aeroloom::layers
