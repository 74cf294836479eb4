/// The foot of a point on an edge's curve.
#pragma once

#include "cad/model/model.hpp"

namespace aeroloom::cad {

struct EdgeFoot {
  double parameter;
  Vec3 point;
  double away;  ///< distance of the point from it
};

/// The nearest place of the edge around the parameter `guess`, by Newton's method with steps that never lead
/// further away; within the edge's ends. Not for degenerate edges.
EdgeFoot foot_on_edge(const Model& model, EdgeId edge, Vec3 point, double guess);

}  // namespace aeroloom::cad
