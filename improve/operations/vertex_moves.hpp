/// Moves of the vertices of a tetrahedron, in the interior and on the CAD.
#pragma once

#include "improve/operations/operation.hpp"
#include "improve/operations/sliding.hpp"
#include "improve/operations/smoothing.hpp"

#include <optional>
#include <vector>

namespace aeroloom::improve {

/// Smooths the interior vertices one by one until the tetrahedron reaches its target.
class VertexSmoothing final : public LocalOperation {
public:
  explicit VertexSmoothing(const OperationContext& context) : _smoothing(context.limits()) {}
  bool improve(OperationContext& context, LocalIndex t) override;

private:
  Smoothing _smoothing;
  RestingVertices _resting;
  std::vector<LocalIndex> _star;
};

/// Slides the boundary vertices in the same way, if the CAD is known.
class VertexSliding final : public LocalOperation {
public:
  explicit VertexSliding(const OperationContext& context) {
    if (context.locator()) _sliding.emplace(*context.locator(), context.limits());
  }
  bool improve(OperationContext& context, LocalIndex t) override;

private:
  std::optional<Sliding> _sliding;
  RestingVertices _resting;
  std::vector<LocalIndex> _star;
};

}  // namespace aeroloom::improve
