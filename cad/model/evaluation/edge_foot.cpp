#include "cad/model/evaluation/edge_foot.hpp"

#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::cad {

EdgeFoot foot_on_edge(const Model& model, EdgeId id, Vec3 point, double guess) {
  constexpr int most_steps =
      8;  // the guess is near, and each step is one along a tangent; chosen, not measured
  const Edge& edge = model.edge(id);
  const double range = edge.last_parameter - edge.first_parameter;
  const auto at = [&](double t) {
    const Vec3 there = model.edge_point(id, t);
    return EdgeFoot{t, there, distance(point, there)};
  };
  EdgeFoot best = at(std::clamp(guess, edge.first_parameter, edge.last_parameter));
  for (int step = 0; step < most_steps; ++step) {
    const Vec3 tangent = model.edge_tangent(id, best.parameter);
    const double square = dot(tangent, tangent);
    if (!(square > 0)) break;
    const double t = std::clamp(best.parameter + dot(point - best.point, tangent) / square,
                                edge.first_parameter, edge.last_parameter);
    const bool arrived = std::abs(t - best.parameter) <= tolerances::same_parameter * range;
    const EdgeFoot next = at(t);
    if (!(next.away < best.away)) break;
    best = next;
    if (arrived) break;
  }
  return best;
}

}  // namespace aeroloom::cad
