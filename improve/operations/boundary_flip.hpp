/// Flip of an edge between two boundary triangles together with the tetrahedra around it: edge removal on the
/// boundary. With a single tetrahedron around the edge, flat on the boundary, the flip takes it away.
#pragma once

#include "improve/operations/boundary_change.hpp"
#include "improve/operations/ring_filling.hpp"
#include "improve/tets/tet_mesh.hpp"

namespace aeroloom::improve {

class BoundaryFlip {
public:
  /// Proposes the flip of edge i of tetrahedron t, both of whose triangles lie on one CAD face. False when
  /// nothing beats both the cavity as it is and `floor`, or the boundary would change too much.
  bool propose(TetMesh& mesh, LocalIndex t, int edge, double floor, CavityReplacement& cavity);

private:
  bool keeps_boundary(TetMesh& mesh);

  Fan _fan;
  RingFilling _filling;
  BoundaryEdges _edges;
};

}  // namespace aeroloom::improve
