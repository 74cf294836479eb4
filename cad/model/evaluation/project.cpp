#include "cad/faceted/faceted_geometry.hpp"
#include "cad/model/model_data.hpp"
#include "cad/model/scaled_model.hpp"
#include "cad/model/topology/sheets.hpp"
#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <GeomAPI_ProjectPointOnSurf.hxx>
#include <gp_Pnt.hxx>

namespace aeroloom::cad {
namespace {

// Steps of a projection whose guess is anywhere on the face, and halvings of one; chosen, not measured. Where
// they do not suffice there are restarts and the library's search.
constexpr int newton_steps = 40, step_halvings = 12;
/// Steps from a guess on the same sheet, which is off by what a file's parameter curve is: Newton's method
/// doubles its digits with each.
constexpr int settling_steps = 8;
/// The Hessian counts as positive definite where it is at least this fraction of the first fundamental form
/// in each parameter, and its determinant the square of it: where the surface bends towards the point by nine
/// tenths of what would make the distance stationary, Newton's step is too long to trust. Chosen, not
/// measured.
constexpr double least_convexity = 0.1, least_convexity2 = 0.01;
/// Of the face, that one step may run through.
constexpr double longest_way = 0.25;

/// Half the squared distance from the target to the surface, and its derivatives.
struct Distance {
  Vec2 uv;
  Vec3 point;
  double value = 0;  // half the squared distance
  Vec2 gradient;
  double huu = 0, huv = 0, hvv = 0;  // Hessian
  double guu = 0, guv = 0, gvv = 0;  // first fundamental form: the Hessian without the surface's curvature
};

class Projector {
public:
  Projector(const FaceEvaluator& face, Vec3 target, double tolerance)
      : _face(face), _target(target), _tolerance(tolerance) {}

  Projection from(Vec2 guess) const {
    Distance at = evaluate(clamp(guess));
    bool converged = false;
    int jumps = 0;
    for (int step = 0; step < newton_steps && !converged; ++step) {
      if (jumps < 2 && jump_across_seam(at)) {
        ++jumps;
        continue;
      }
      converged = !descend(at) && !leave_pole(at);
    }
    return {wrap(at.uv), at.point, converged};
  }

  /// Nearest point of the same sheet around the guess: neither wrapped nor moved to another end.
  Vec2 slide_to(Vec2 guess) const {
    Distance at = evaluate(clamp(guess));
    for (int step = 0; step < settling_steps && at.value > 0.5 * _tolerance * _tolerance && descend(at);
         ++step) {
    }
    return at.uv;
  }

  double distance(const Projection& found) const { return geometry::distance(_target, found.point); }

private:
  Distance evaluate(Vec2 uv) const {
    Distance at;
    at.uv = uv;
    const SurfaceJet jet = _face.surface.jet(uv, 2);
    at.point = jet.point;
    const Vec3 offset = jet.point - _target;
    at.value = 0.5 * dot(offset, offset);
    at.gradient = {dot(offset, jet.du), dot(offset, jet.dv)};
    at.guu = dot(jet.du, jet.du), at.guv = dot(jet.du, jet.dv), at.gvv = dot(jet.dv, jet.dv);
    at.huu = at.guu + dot(offset, jet.duu);
    at.huv = at.guv + dot(offset, jet.duv);
    at.hvv = at.gvv + dot(offset, jet.dvv);
    return at;
  }

  /// One damped step. False when the point cannot get closer: it is the nearest.
  bool descend(Distance& at) const {
    const Vec2 direction = shorten(newton_direction(at));
    double fraction = 1;
    for (int halving = 0; halving < step_halvings; ++halving, fraction *= 0.5) {
      const Vec2 target = clamp(at.uv + fraction * direction);
      const Vec2 move = target - at.uv;
      const double length2 =
          at.guu * move.x * move.x + 2 * at.guv * move.x * move.y + at.gvv * move.y * move.y;
      if (length2 <= _tolerance * _tolerance) return false;
      const Distance next = evaluate(target);
      if (next.value < at.value) {
        at = next;
        return true;
      }
    }
    return false;
  }

  /// Newton's direction where the Hessian is safely positive definite, Gauss and Newton's elsewhere; a
  /// parameter that the gradient pushes out of its range stays.
  Vec2 newton_direction(const Distance& at) const {
    const bool hold_u = pushed_out(at.uv.x, at.gradient.x, _face.u);
    const bool hold_v = pushed_out(at.uv.y, at.gradient.y, _face.v);
    const bool convex = at.huu > least_convexity * at.guu && at.hvv > least_convexity * at.gvv &&
                        at.huu * at.hvv - at.huv * at.huv > least_convexity2 * at.guu * at.gvv;
    const double a = convex ? at.huu : at.guu, b = convex ? at.huv : at.guv, c = convex ? at.hvv : at.gvv;
    if (hold_u && hold_v) return {};
    if (hold_u) return {0, c > 0 ? -at.gradient.y / c : 0};
    if (hold_v) return {a > 0 ? -at.gradient.x / a : 0, 0};
    const double determinant = a * c - b * b;
    if (determinant > tolerances::rounding_of_squares * a * c) {
      return {(-at.gradient.x * c + at.gradient.y * b) / determinant,
              (-at.gradient.y * a + at.gradient.x * b) / determinant};
    }
    // Singular, at a pole: along the direction that moves the point.
    return a >= c ? Vec2{a > 0 ? -at.gradient.x / a : 0, 0} : Vec2{0, -at.gradient.y / c};
  }

  /// Near a pole a step may run round the surface many times: a quarter of the face is far enough.
  Vec2 shorten(Vec2 direction) const {
    const double fraction = std::max(std::abs(direction.x) / extent().x, std::abs(direction.y) / extent().y);
    return fraction > longest_way ? (longest_way / fraction) * direction : direction;
  }

  Vec2 extent() const { return _face.uv_high - _face.uv_low; }

  /// At a pole all directions but one look alike to derivatives: tries the others. False when none leads
  /// closer.
  bool leave_pole(Distance& at) const {
    constexpr int directions = 16;  // round a pole; chosen, not measured
    const double along_u = at.guu * extent().x * extent().x, along_v = at.gvv * extent().y * extent().y;
    if (std::min(along_u, along_v) > tolerances::rounding_of_squares * std::max(along_u, along_v))
      return false;
    const bool u_collapses = along_u < along_v;
    const Vec2 inward = tolerances::beside_end * (0.5 * (_face.uv_low + _face.uv_high) - at.uv);
    Distance best = at;
    for (int i = 0; i < directions; ++i) {
      const Vec2 swept = _face.uv_low + (i + 0.5) / directions * extent();
      const Distance there = evaluate(
          clamp(u_collapses ? Vec2{swept.x, at.uv.y + inward.y} : Vec2{at.uv.x + inward.x, swept.y}));
      if (there.value < best.value) best = there;
    }
    const bool closer = best.value < at.value;
    at = best;
    return closer;
  }

  static bool pushed_out(double parameter, double gradient, const ParameterRange& range) {
    if (range.period > 0) return false;
    return (parameter <= range.low && gradient > 0) || (parameter >= range.high && gradient < 0);
  }

  /// On a surface that closes without being periodic, a point held at one end may go on at the other.
  bool jump_across_seam(Distance& at) const {
    Vec2 other = at.uv;
    const bool in_u = _face.u.closed && pushed_out(at.uv.x, at.gradient.x, _face.u);
    const bool in_v = _face.v.closed && pushed_out(at.uv.y, at.gradient.y, _face.v);
    if (!in_u && !in_v) return false;
    if (in_u) other.x = at.uv.x <= _face.u.low ? _face.u.high : _face.u.low;
    if (in_v) other.y = at.uv.y <= _face.v.low ? _face.v.high : _face.v.low;
    const Distance there = evaluate(other);
    const bool stuck = (in_u && pushed_out(other.x, there.gradient.x, _face.u)) ||
                       (in_v && pushed_out(other.y, there.gradient.y, _face.v));
    if (stuck) return false;
    at = there;
    return true;
  }

  Vec2 clamp(Vec2 uv) const {
    if (_face.u.period == 0) uv.x = std::clamp(uv.x, _face.u.low, _face.u.high);
    if (_face.v.period == 0) uv.y = std::clamp(uv.y, _face.v.low, _face.v.high);
    return uv;
  }

  Vec2 wrap(Vec2 uv) const {
    return {wrap_parameter(uv.x, _face.u.low, _face.u.high, _face.u.period),
            wrap_parameter(uv.y, _face.v.low, _face.v.high, _face.v.period)};
  }

  const FaceEvaluator& _face;
  Vec3 _target;
  double _tolerance;
};

Vec2 nearest_sample(const FaceEvaluator& face, Vec3 target) {
  constexpr int samples = 12;  // each way, where a guess led nowhere; chosen, not measured
  Vec2 best;
  double least = std::numeric_limits<double>::max();
  for (int i = 0; i <= samples; ++i) {
    for (int j = 0; j <= samples; ++j) {
      const Vec2 uv{face.uv_low.x + (face.uv_high.x - face.uv_low.x) * i / samples,
                    face.uv_low.y + (face.uv_high.y - face.uv_low.y) * j / samples};
      const double away = distance(target, face.surface.point(uv));
      if (away < least) least = away, best = uv;
    }
  }
  return best;
}

/// The CAD library's global search: slow, for points where Newton's method finds nothing.
Projection search(const FaceEvaluator& face, Vec3 target, const Projection& best) {
  try {
    GeomAPI_ProjectPointOnSurf search(gp_Pnt(target.x, target.y, target.z), face.surface.adaptor().Surface(),
                                      face.uv_low.x, face.uv_high.x, face.uv_low.y, face.uv_high.y);
    if (search.NbPoints() == 0 || search.LowerDistance() > distance(best.point, target)) return best;
    Projection found;
    search.LowerDistanceParameters(found.uv.x, found.uv.y);
    const gp_Pnt point = search.NearestPoint();
    found.point = {point.X(), point.Y(), point.Z()};
    found.converged = true;
    return found;
  } catch (const Standard_Failure&) {
    return best;
  }
}

}  // namespace

Vec2 find_parameters(const FaceEvaluator& face, Vec3 point, Vec2 guess, double tolerance) {
  return Projector(face, point, tolerance).slide_to(guess);
}

Projection Model::project(FaceId id, Vec3 point, Vec2 guess) const {
  if (_data->scaled) return _data->scaled->project(id, point, guess);
  if (_data->joined) return _data->joined->project(id, point, guess);
  if (const FacetedGeometry* faceted = _data->faceted_face(id))
    return faceted->project(id - _data->first_faceted_face, point, guess);
  const FaceEvaluator& face = _data->face_evaluators.at(id);
  const Projector projector(face, point, tolerances::foot * _data->bounds.diagonal());
  Projection best = projector.from(guess);
  if (!best.converged) {
    const Projection restarted = projector.from(nearest_sample(face, point));
    if (restarted.converged || projector.distance(restarted) < projector.distance(best)) best = restarted;
    if (!best.converged) best = search(face, point, best);
  }
  best.point = _data->face_snaps[id](best.point);
  return best;
}

}  // namespace aeroloom::cad
