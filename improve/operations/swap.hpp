/// Swaps: the tetrahedra at an edge or a face are replaced, vertices stay.
#pragma once

#include "improve/operations/boundary_flip.hpp"
#include "improve/operations/edge_removal.hpp"
#include "improve/operations/face_removal.hpp"
#include "improve/operations/operation.hpp"

namespace aeroloom::improve {

/// Does the best of all removals of an edge or a face of the tetrahedron; where the edge is on the boundary,
/// it flips.
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
