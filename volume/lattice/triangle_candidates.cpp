#include "volume/lattice/triangle_candidates.hpp"

#include <cmath>

namespace aeroloom::volume {

using geometry::Vec3;

namespace {

/// Radii are enlarged by this factor, to allow for rounding.
constexpr double more = 1 + 1e-9;

double square(double x) {
  return x * x;
}

}  // namespace

void TriangleCandidates::collect(const BoundaryDistance& boundary, const geometry::Box& box, double radius) {
  _radius = radius;
  _balls.clear();
  _triangles.clear();
  const double margin = more * radius;
  boundary.for_each_in(box.dilated(margin), [&](const BoundaryDistance::Measured& triangle) {
    const auto& [a, b, c] = triangle.corners;
    const Vec3 center = (a + b + c) / 3;
    const double squared =
        std::max({dot(a - center, a - center), dot(b - center, b - center), dot(c - center, c - center)});
    const double radius = more * std::sqrt(squared);
    if (BoundaryDistance::squared_distance(center, box) > square(margin + radius)) return;
    _balls.push_back({center, radius});
    _triangles.push_back(triangle);
  });
}

bool TriangleCandidates::any_nearer(Vec3 p, const Clearance& clearance) const {
  for (std::size_t i = 0; i < _balls.size(); ++i) {
    const double limit = clearance.from(_triangles[i].mean_edge);
    if (dot(p - _balls[i].center, p - _balls[i].center) > square(limit + _balls[i].radius)) continue;
    if (BoundaryDistance::squared_distance(p, _triangles[i].corners).squared < square(limit)) return true;
  }
  return false;
}

bool TriangleCandidates::any_corner_nearer(Vec3 p, double distance) const {
  for (std::size_t i = 0; i < _balls.size(); ++i) {
    if (dot(p - _balls[i].center, p - _balls[i].center) > square(distance + _balls[i].radius)) continue;
    const auto& [a, b, c] = _triangles[i].corners;
    if (std::min({dot(a - p, a - p), dot(b - p, b - p), dot(c - p, c - p)}) < square(distance)) return true;
  }
  return false;
}

std::optional<BoundaryDistance::Nearest> TriangleCandidates::nearest(Vec3 p) const {
  BoundaryDistance::Nearest nearest;
  double best = _radius, best_squared = square(_radius);
  for (std::size_t i = 0; i < _balls.size(); ++i) {
    if (dot(p - _balls[i].center, p - _balls[i].center) > square(best + _balls[i].radius)) continue;
    const auto [squared, in_face] = BoundaryDistance::squared_distance(p, _triangles[i].corners);
    if (squared >= best_squared) continue;
    best_squared = squared;
    best = more * std::sqrt(squared);
    nearest.triangle = _triangles[i].triangle;
    nearest.in_face = in_face;
  }
  if (nearest.triangle < 0) return std::nullopt;
  nearest.distance = std::sqrt(best_squared);
  return nearest;
}

}  // namespace aeroloom::volume
