/// Replacement of a cavity by the tetrahedra around one vertex, which is moved or new.
#pragma once

#include "improve/operations/cavity_insertion.hpp"
#include "improve/operations/operation.hpp"

namespace aeroloom::improve {

/// Replaces a cavity grown from the star of a free vertex of the tetrahedron.
class VertexReinsertion final : public LocalOperation {
public:
  bool improve(OperationContext& context, LocalIndex t) override;

private:
  CavityInsertion _insertion;
  RestingVertices _resting;
  CavityReplacement _trial;
};

/// Replaces a cavity grown from the tetrahedron. With full effort, growth starts at several places.
class VertexInsertion final : public LocalOperation {
public:
  bool improve(OperationContext& context, LocalIndex t) override;

private:
  CavityInsertion _insertion;
  CavityReplacement _best, _trial;
};

}  // namespace aeroloom::improve
