/// Contraction of an edge: one vertex moves into the other, and the tetrahedra at the edge vanish.
#pragma once

#include "improve/operations/boundary_change.hpp"
#include "improve/operations/operation.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <vector>

namespace aeroloom::improve {

/// A vertex inside the region contracts into any neighbour, one inside a CAD face along the boundary on that
/// face. No edge gets longer than 1.5 times the longest one at the vertex.
class EdgeContraction final : public LocalOperation {
public:
  /// Contracts the edge of the tetrahedron that improves the mesh most.
  bool improve(OperationContext& context, LocalIndex t) override;
  /// Proposes to contract `from` into its neighbour `to`. False if nothing beats both the star of `from` and
  /// `floor`, `from` must stay, or the boundary would change too much.
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
