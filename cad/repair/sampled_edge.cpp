#include "cad/repair/sampled_edge.hpp"

#include "cad/model/to_vec.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aeroloom::cad {
namespace {

/// Chords stand for an edge where it is looked for near a point, and feet start from them. Chosen, not
/// measured.
constexpr int edge_intervals = 32;
/// Steps along tangents to a foot, and halvings of one that leads away; chosen, not measured.
constexpr int rounds = 20, halvings_of_foot = 5;

}  // namespace

SampledEdge::SampledEdge(const TopoDS_Edge& edge) : _curve(edge) {
  for (int i = 0; i <= edge_intervals; ++i) {
    _points.push_back(point(parameter(static_cast<double>(i) / edge_intervals)));
    if (i > 0) _length += distance(_points[i - 1], _points[i]);
  }
}

Vec3 SampledEdge::point(double parameter) const {
  return to_vec(_curve.Value(parameter));
}

Vec3 SampledEdge::tangent(double parameter) const {
  gp_Pnt p;
  gp_Vec along;
  _curve.D1(parameter, p, along);
  return to_vec(along);
}

SampledEdge::Foot SampledEdge::nearest_around(Vec3 p, double parameter) const {
  Foot best{parameter, distance(point(parameter), p)};
  for (int i = 0; i < rounds; ++i) {
    const Vec3 along = tangent(best.parameter);
    const double square = dot(along, along);
    if (square == 0) break;
    double step = dot(p - point(best.parameter), along) / square;
    bool nearer = false;
    for (int half = 0; half < halvings_of_foot && !nearer; ++half, step *= 0.5) {
      const double t = std::clamp(best.parameter + step, first(), last());
      const double away = distance(point(t), p);
      if (away >= best.away) continue;
      nearer = true;
      best = {t, away};
    }
    if (!nearer) break;
  }
  return best;
}

SampledEdge::Foot SampledEdge::nearest(Vec3 p, double bound) const {
  Foot best{first(), std::numeric_limits<double>::infinity()};
  for (int i = 0; i < edge_intervals; ++i) {
    const Vec3 a = _points[i], along = _points[i + 1] - a;
    const double square = dot(along, along);
    const double fraction = square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
    const double away = distance(a + fraction * along, p);
    // A curve leaves its chords by less than their length.
    if (away > std::min(best.away, bound) + std::sqrt(square)) continue;
    const Foot foot = nearest_around(p, parameter((i + fraction) / edge_intervals));
    if (foot.away < best.away) best = foot;
  }
  return best;
}

}  // namespace aeroloom::cad
