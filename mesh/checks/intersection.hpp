/// Self-intersection of a distributed surface, by exact predicates.
#pragma once

#include "mesh/checks/triangle_contact.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"
#include "parallel/observation/timers.hpp"

#include <vector>

namespace aeroloom::mesh {

/// Two triangles that meet elsewhere than in a common vertex or edge.
struct TriangleHit {
  PieceId first_piece, second_piece;  ///< first <= second
  LocalIndex first, second;           ///< cells of those pieces
  geometry::Vec3 center;              ///< of the first triangle
  double size;                        ///< shortest edge of both
  double first_area, second_area;
};

/// The names of a piece's vertices over all pieces: their keys where they have one.
std::vector<VertexName> name_vertices(const Piece& piece);

/// All hits, ascending, the same on every rank. Triangles are spread over ranks by place for the test.
/// Vertices are the same when their shared-vertex keys are (across pieces) or their indices (within one).
/// Collective.
std::vector<TriangleHit> find_intersections(const DistributedMesh& surface);

}  // namespace aeroloom::mesh
