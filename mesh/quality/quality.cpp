#include "mesh/quality/quality.hpp"

#include "geometry/angle.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::mesh {

using geometry::cross;
using geometry::dot;
using geometry::norm;
using geometry::Vec3;

namespace {

/// Angle at `apex` of the triangle (apex, b, c), degrees.
double angle_at(Vec3 apex, Vec3 b, Vec3 c) {
  const Vec3 u = b - apex, v = c - apex;
  return geometry::degrees_per_radian * angle_between(u, v);
}

double squared_edges(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  return dot(b - a, b - a) + dot(c - a, c - a) + dot(d - a, d - a) + dot(c - b, c - b) + dot(d - b, d - b) +
         dot(d - c, d - c);
}

}  // namespace

DihedralRange dihedral_range(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const double volume = geometry::volume6(a, b, c, d);
  if (!(volume > 0)) return {};
  // Outward normals, normal i opposite vertex i.
  const Vec3 normals[4] = {cross(c - b, d - b), cross(d - a, c - a), cross(b - a, d - a),
                           cross(c - a, b - a)};
  const auto scaled_cosine = [&](int i, int j, Vec3 edge) {
    return -dot(normals[i], normals[j]) / norm(edge);
  };
  // At an edge e between faces i and j, |n_i| |n_j| sin = 6 V |e| and |n_i| |n_j| cos = -n_i.n_j. So the
  // angle is that of (x, y) = (-n_i.n_j / |e|, 6 V), falls as x grows, and keeps full accuracy near 0 and 180
  // degrees.
  const double x[6] = {scaled_cosine(2, 3, b - a), scaled_cosine(1, 3, c - a), scaled_cosine(1, 2, d - a),
                       scaled_cosine(0, 3, c - b), scaled_cosine(0, 2, d - b), scaled_cosine(0, 1, d - c)};
  const auto [lowest, highest] = std::minmax_element(x, x + 6);
  return {geometry::degrees_per_radian * std::atan2(volume, *highest),
          geometry::degrees_per_radian * std::atan2(volume, *lowest)};
}

double mean_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const double root = std::cbrt(geometry::volume6(a, b, c, d) / 2);
  const double edges = squared_edges(a, b, c, d);
  return edges > 0 ? 12 * root * std::abs(root) / edges : 0;
}

double radius_ratio(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const Vec3 u = b - a, v = c - a, w = d - a;
  const double volume = geometry::volume6(a, b, c, d);
  // r = 6V / sum |n_i|, R = |N| / 12V with the numerator N of the circumcentre.
  const Vec3 numerator = dot(u, u) * cross(v, w) + dot(v, v) * cross(w, u) + dot(w, w) * cross(u, v);
  const double normals =
      norm(cross(c - b, d - b)) + norm(cross(v, w)) + norm(cross(u, w)) + norm(cross(u, v));
  const double product = normals * norm(numerator);
  return product > 0 ? 6 * volume * std::abs(volume) / product : 0;
}

double triangle_mean_ratio(Vec3 a, Vec3 b, Vec3 c) {
  const double edges = dot(b - a, b - a) + dot(c - b, c - b) + dot(a - c, a - c);
  return edges > 0 ? 2 * std::numbers::sqrt3 * norm(cross(b - a, c - a)) / edges : 0;
}

double smallest_angle(Vec3 a, Vec3 b, Vec3 c) {
  return std::min({angle_at(a, b, c), angle_at(b, c, a), angle_at(c, a, b)});
}

double largest_angle(Vec3 a, Vec3 b, Vec3 c) {
  return std::max({angle_at(a, b, c), angle_at(b, c, a), angle_at(c, a, b)});
}

}  // namespace aeroloom::mesh
