/// Replacement of a cavity by tetrahedra around one vertex: an old one that moves, or a new one.
#pragma once

#include "improve/operations/cavity_insertion.hpp"
#include "improve/operations/operation.hpp"

namespace aeroloom::improve {

/// Replaces a cavity that grows from the star of a free vertex of the tetrahedron.
class VertexReinsertion final : public LocalOperation {
public:
  bool improve(OperationContext& context, LocalIndex t) override;

private:
  CavityInsertion _insertion;
  RestingVertices _resting;
  CavityReplacement _trial;
};

/// Replaces a cavity that grows from the tetrahedron. With full effort, growth begins at several places.
class VertexInsertion final : public LocalOperation {
public:
  bool improve(OperationContext& context, LocalIndex t) override;

private:
  CavityInsertion _insertion;
  CavityReplacement _best, _trial;
};

}  // namespace aeroloom::improve
