#include "cad/model/evaluation/point_locator.hpp"

#include "cad/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace aeroloom::cad {
namespace {

/// Samples of a face are as dense as its curvature asks for: Newton's method converges from the nearest.
/// Chosen, not measured.
constexpr double facet_angle = 20 * std::numbers::pi / 180;
constexpr double facet_deflection = 0.01;  // of the body
/// The body counts as no smaller than this fraction of everything: a far field needs no more samples the
/// farther it is.
constexpr double least_body = 1.0 / 400;
/// Of a curve, where it is smooth; chosen, not measured.
constexpr int samples_per_interval = 32;
/// Where sheets pass close to each other the nearest sample may lie on the other one: so many are started
/// from.
constexpr std::size_t most_starts = 8;
/// Steps along tangents, and halvings of one that leads away: at a place where the curve bends round the
/// point. Chosen, not measured.
constexpr int most_steps = 20, most_halvings = 8;

/// The samples nearest to a point, nearest first; ties by number.
std::vector<std::int32_t> nearest(const std::vector<Vec3>& samples, Vec3 point) {
  std::vector<std::int32_t> order(samples.size());
  std::iota(order.begin(), order.end(), 0);
  const auto count = static_cast<std::ptrdiff_t>(std::min(most_starts, order.size()));
  const auto away = [&](std::int32_t i) { return dot(samples[i] - point, samples[i] - point); };
  std::partial_sort(order.begin(), order.begin() + count, order.end(), [&](std::int32_t a, std::int32_t b) {
    const double of_a = away(a), of_b = away(b);
    return of_a != of_b ? of_a < of_b : a < b;
  });
  order.resize(count);
  return order;
}

}  // namespace

PointLocator::PointLocator(const Model& model)
    : _model(model), _faces(model.face_count()), _edges(model.edge_count()) {}

void PointLocator::sample(FaceId id, FaceSamples& samples) const {
  samples.made = true;
  try {
    const double body = std::max(_model.body_bounds().diagonal(), least_body * _model.bounds().diagonal());
    Facets facets = _model.facets(id, facet_deflection * body, facet_angle);
    samples.points = std::move(facets.points);
    samples.uv = std::move(facets.uv);
  } catch (const CadError&) {
    // Without samples nothing is found on this face.
  }
}

void PointLocator::sample(EdgeId id, EdgeSamples& samples) const {
  if (_model.edge(id).degenerate) return;
  const std::vector<double> breaks = _model.edge_breaks(id);
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
    for (int k = 0; k <= samples_per_interval; ++k) {
      const double fraction = static_cast<double>(k) / samples_per_interval;
      const double parameter = (1 - fraction) * breaks[i] + fraction * breaks[i + 1];
      samples.parameters.push_back(parameter);
      samples.points.push_back(_model.edge_point(id, parameter));
    }
  }
}

std::optional<Vec2> PointLocator::on_face(FaceId id, Vec3 point, double tolerance) {
  FaceSamples& samples = _faces.at(id);
  if (!samples.made) sample(id, samples);
  for (const std::int32_t start : nearest(samples.points, point)) {
    const Projection found = _model.project(id, point, samples.uv[start]);
    if (found.converged && distance(found.point, point) <= tolerance) return found.uv;
  }
  return std::nullopt;
}

std::optional<double> PointLocator::on_edge(EdgeId id, Vec3 point, double tolerance) {
  EdgeSamples& samples = _edges.at(id);
  if (samples.points.empty()) sample(id, samples);
  for (const std::int32_t start : nearest(samples.points, point)) {
    const double found = project_on_edge(_model, id, point, samples.parameters[start]);
    if (distance(_model.edge_point(id, found), point) <= tolerance) return found;
  }
  return std::nullopt;
}

double project_on_edge(const Model& model, EdgeId id, Vec3 point, double guess) {
  const Edge& edge = model.edge(id);
  const auto clamp = [&](double t) { return std::clamp(t, edge.first_parameter, edge.last_parameter); };
  const double resolution = tolerances::parameter_rounding * (edge.last_parameter - edge.first_parameter);
  double at = clamp(guess);
  double away = distance(model.edge_point(id, at), point);
  for (int i = 0; i < most_steps; ++i) {
    const Vec3 tangent = model.edge_tangent(id, at);
    const double speed2 = dot(tangent, tangent);
    if (!(speed2 > 0)) break;
    double step = dot(point - model.edge_point(id, at), tangent) / speed2;
    double next = clamp(at + step), closer = distance(model.edge_point(id, next), point);
    for (int halving = 0; halving < most_halvings && closer > away; ++halving) {
      step *= 0.5;
      next = clamp(at + step);
      closer = distance(model.edge_point(id, next), point);
    }
    if (!(closer < away)) break;
    const bool converged = std::abs(next - at) <= resolution;
    at = next;
    away = closer;
    if (converged) break;
  }
  return at;
}

Vec3 onto_exact_plane(const Model& model, FaceId face, Vec3 point) {
  if (!model.is_exact_plane(face)) return point;
  const Coedge& use = model.face(face).loops.front().front();
  const SurfaceFrame frame =
      model.face_frame(face, model.edge_uv(face, use, model.edge(use.edge).first_parameter));
  int along = 0;
  for (const int axis : {1, 2}) {
    if (std::abs(frame.normal[axis]) > std::abs(frame.normal[along])) along = axis;
  }
  point[along] = frame.point[along];
  return point;
}

EdgeFoot foot_on_edge(const Model& model, EdgeId id, Vec3 point, double guess) {
  constexpr int few_steps = 8;  // the guess is near, each step is one along a tangent; chosen, not measured
  const Edge& edge = model.edge(id);
  const double range = edge.last_parameter - edge.first_parameter;
  const auto at = [&](double t) {
    const Vec3 there = model.edge_point(id, t);
    return EdgeFoot{t, there, distance(point, there)};
  };
  EdgeFoot best = at(std::clamp(guess, edge.first_parameter, edge.last_parameter));
  for (int step = 0; step < few_steps; ++step) {
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
