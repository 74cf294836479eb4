/// Removal of an interior edge. The tetrahedra around it are replaced by the best pair of cones over a
/// triangulation of their ring (3-2 and 4-4 swaps and their generalisation).
#pragma once

#include "improve/operations/ring_filling.hpp"
#include "improve/tets/tet_mesh.hpp"

namespace aeroloom::improve {

class EdgeRemoval {
public:
  static constexpr int largest_ring = RingFilling::largest_ring;

  /// Proposes to remove edge i of tetrahedron t. False if nothing beats both the cavity and `floor`.
  bool propose(const TetMesh& mesh, LocalIndex t, int edge, double floor, CavityReplacement& cavity);

private:
  EdgeRing _edge_ring;
  RingFilling _filling;
};

}  // namespace aeroloom::improve
