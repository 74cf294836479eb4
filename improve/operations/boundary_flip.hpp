/// Flip of a boundary edge together with the tetrahedra around it, as edge removal on the boundary. A single
/// flat tetrahedron at the edge is removed by the flip.
#pragma once

#include "improve/operations/boundary_change.hpp"
#include "improve/operations/ring_filling.hpp"
#include "improve/tets/tet_mesh.hpp"

namespace aeroloom::improve {

class BoundaryFlip {
public:
  /// Proposes to flip edge i of tetrahedron t, whose two boundary triangles lie on one CAD face. False if
  /// nothing beats both the cavity and `floor`, or the boundary would change too much.
  bool propose(TetMesh& mesh, LocalIndex t, int edge, double floor, CavityReplacement& cavity);

private:
  bool keeps_boundary(TetMesh& mesh);

  Fan _fan;
  RingFilling _filling;
  BoundaryEdges _edges;
};

}  // namespace aeroloom::improve
