/// Contraction of an edge: one of its vertices moves into the other, the tetrahedra at the edge vanish.
#pragma once

#include "improve/operations/boundary_change.hpp"
#include "improve/operations/operation.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <vector>

namespace aeroloom::improve {

/// Vertices inside the region vanish into any neighbour, vertices inside a CAD face into one along the
/// boundary of this face. No edge becomes longer than 1.5 times the longest one at the vertex.
class EdgeContraction final : public LocalOperation {
public:
  /// Contracts the edge of the tetrahedron that gains most.
  bool improve(OperationContext& context, LocalIndex t) override;
  /// Proposes to move `from` into its neighbour `to`. False when nothing beats both the tetrahedra around
  /// `from` as they are and `floor`, `from` must stay, or the boundary would change too much.
  bool propose(TetMesh& mesh, LocalIndex from, LocalIndex to, double floor, CavityReplacement& cavity);

private:
  bool may_vanish(const TetMesh& mesh, LocalIndex from, LocalIndex to);
  bool keeps_boundary(TetMesh& mesh, LocalIndex from, LocalIndex to);
  bool keeps_lengths(const TetMesh& mesh, LocalIndex from, LocalIndex to) const;

  std::vector<LocalIndex> _star, _triangles;
  std::vector<TrianglePoints> _before, _after;
  BoundaryEdges _edges;
  CavityReplacement _best, _change;
};

}  // namespace aeroloom::improve
