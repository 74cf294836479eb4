/// Swaps: replace the tetrahedra at an edge or a face and keep all vertices.
#pragma once

#include "improve/operations/boundary_flip.hpp"
#include "improve/operations/edge_removal.hpp"
#include "improve/operations/face_removal.hpp"
#include "improve/operations/operation.hpp"

namespace aeroloom::improve {

/// Makes the best of all edge and face removals at a tetrahedron. Edges on the boundary flip.
class Swap final : public LocalOperation {
public:
  bool improve(OperationContext& context, LocalIndex t) override;

private:
  EdgeRemoval _edge_removal;
  BoundaryFlip _boundary_flip;
  FaceRemoval _face_removal;
  CavityReplacement _best, _trial;
};

}  // namespace aeroloom::improve
