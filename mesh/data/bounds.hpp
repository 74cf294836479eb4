/// Boxes around what all ranks have.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"

namespace aeroloom::mesh {

/// The box around the boxes of all ranks. Collective.
inline geometry::Box box_over_ranks(const parallel::Communicator& communicator, geometry::Box mine) {
  for (int axis = 0; axis < 3; ++axis) {
    mine.low[axis] = communicator.minimum(mine.low[axis]);
    mine.high[axis] = communicator.maximum(mine.high[axis]);
  }
  return mine;
}

/// The box around all vertices of the mesh. Collective.
inline geometry::Box box_of(const DistributedMesh& mesh) {
  geometry::Box box;
  for (const Piece& piece : mesh.pieces) {
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) box.add(piece.point(v));
  }
  return box_over_ranks(mesh.communicator, box);
}

}  // namespace aeroloom::mesh
