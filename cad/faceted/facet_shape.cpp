#include "cad/faceted/facet_shape.hpp"

#include "cad/faceted/facet_soup.hpp"
#include "geometry/angle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace aeroloom::cad {
namespace {

/// A triangle lower than this times its longest side has the normal that rounding gave it. Files of single
/// precision: heights of 1e-7 of a length are noise. Chosen, not measured.
constexpr double least_slenderness = 1e-5;
/// No curvature is more than so many times what a quarter of those around it exceed: a fillet of one strip
/// between planes keeps its own, a spike of noise does not. Chosen, not measured.
constexpr double most_over_quartile = 2;

struct SymmetricTensor {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  void add(double weight, Vec3 a, Vec3 b) {  // weight (a b' + b a') / 2
    xx += weight * a.x * b.x, yy += weight * a.y * b.y, zz += weight * a.z * b.z;
    xy += weight * 0.5 * (a.x * b.y + a.y * b.x);
    xz += weight * 0.5 * (a.x * b.z + a.z * b.x);
    yz += weight * 0.5 * (a.y * b.z + a.z * b.y);
  }
  double operator()(Vec3 a, Vec3 b) const {
    return a.x * (xx * b.x + xy * b.y + xz * b.z) + a.y * (xy * b.x + yy * b.y + yz * b.z) +
           a.z * (xz * b.x + yz * b.y + zz * b.z);
  }
};

bool has_direction(const std::array<Vec3, 3>& p) {
  double longest2 = 0;
  for (int i = 0; i < 3; ++i)
    longest2 = std::max(longest2, dot(p[(i + 1) % 3] - p[i], p[(i + 1) % 3] - p[i]));
  return norm(cross(p[1] - p[0], p[2] - p[0])) > least_slenderness * longest2;
}

std::vector<Vec3> facet_normals(const std::vector<Vec3>& points,
                                const std::vector<geometry::TriangleCorners>& triangles) {
  std::vector<Vec3> sums(points.size()), rough(points.size());
  for (const auto& t : triangles) {
    const std::array<Vec3, 3> p{points[t[0]], points[t[1]], points[t[2]]};
    const Vec3 area = cross(p[1] - p[0], p[2] - p[0]);
    for (const std::int32_t v : t) rough[v] += area;
    if (!has_direction(p)) continue;
    for (int i = 0; i < 3; ++i) {
      sums[t[i]] += angle_between(p[(i + 1) % 3] - p[i], p[(i + 2) % 3] - p[i]) * normalized(area);
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v)
    sums[v] = normalized(dot(sums[v], sums[v]) > 0 ? sums[v] : rough[v]);
  return sums;
}

/// The second fundamental form over a triangle that fits the change of normals along its sides best, in the
/// frame (u, v): its entries uu, uv, vv. False where the sides do not tell.
bool fit_form(const std::array<Vec3, 3>& p, const std::array<Vec3, 3>& n, Vec3 u, Vec3 v, double (&form)[3]) {
  double uu = 0, uv = 0, vv = 0, right[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i) {
    const Vec3 side = p[(i + 1) % 3] - p[i], turn = n[(i + 1) % 3] - n[i];
    const double a = dot(side, u), b = dot(side, v);
    uu += a * a, uv += a * b, vv += b * b;
    right[0] += dot(turn, u) * a;
    right[1] += dot(turn, u) * b + dot(turn, v) * a;
    right[2] += dot(turn, v) * b;
  }
  // [uu uv 0; uv uu+vv uv; 0 uv vv] form = right, by Cramer's rule.
  const double middle = uu + vv;
  const double determinant = uu * (middle * vv - uv * uv) - uv * uv * vv;
  if (!(determinant > 0)) return false;
  form[0] = (right[0] * (middle * vv - uv * uv) - uv * (right[1] * vv - uv * right[2])) / determinant;
  form[1] = (uu * (right[1] * vv - uv * right[2]) - right[0] * uv * vv) / determinant;
  form[2] =
      (uu * (middle * right[2] - right[1] * uv) - uv * (uv * right[2]) + right[0] * uv * uv) / determinant;
  return std::isfinite(form[0]) && std::isfinite(form[1]) && std::isfinite(form[2]);
}

PrincipalCurvatures principal(const SymmetricTensor& tensor, Vec3 normal) {
  const Vec3 s = normalized(cross(farthest_axis(normal), normal)), t = cross(normal, s);
  const double a = tensor(s, s), b = tensor(s, t), c = tensor(t, t);
  const double spread = std::hypot(0.5 * (a - c), b), mean = 0.5 * (a + c);
  const double first = std::abs(mean + spread), second = std::abs(mean - spread);
  return {std::max(first, second), std::min(first, second), true};
}

/// Cuts what stands out from the points around.
void bound_by_quartile(const std::vector<geometry::TriangleCorners>& triangles,
                       std::vector<PrincipalCurvatures>& curvatures) {
  std::vector<std::int32_t> begin(curvatures.size() + 1, 0);
  for (const auto& t : triangles) {
    for (const std::int32_t v : t) begin[v + 1] += 2;
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<double> around(begin.back());
  std::vector<std::int32_t> at(begin.begin(), begin.end() - 1);
  for (const auto& t : triangles) {
    for (int i = 0; i < 3; ++i) {
      for (int other = 1; other < 3; ++other) around[at[t[i]]++] = curvatures[t[(i + other) % 3]].largest;
    }
  }
  for (std::size_t v = 0; v < curvatures.size(); ++v) {
    const auto first = around.begin() + begin[v], last = around.begin() + begin[v + 1];
    if (first == last) continue;
    const auto upper = first + 3 * (last - first) / 4;
    std::nth_element(first, upper, last);
    curvatures[v].largest = std::min(curvatures[v].largest, most_over_quartile * *upper);
    curvatures[v].smallest = std::min(curvatures[v].smallest, curvatures[v].largest);
  }
}

}  // namespace

FacetShape shape_of(const std::vector<Vec3>& points,
                    const std::vector<geometry::TriangleCorners>& triangles) {
  FacetShape shape{facet_normals(points, triangles), {}};
  std::vector<SymmetricTensor> tensors(points.size());
  std::vector<double> weights(points.size(), 0);
  for (const auto& t : triangles) {
    const std::array<Vec3, 3> p{points[t[0]], points[t[1]], points[t[2]]};
    if (!has_direction(p)) continue;
    const Vec3 area = cross(p[1] - p[0], p[2] - p[0]);
    const Vec3 u = normalized(p[1] - p[0]), v = cross(normalized(area), u);
    double form[3];
    if (!fit_form(p, {shape.normals[t[0]], shape.normals[t[1]], shape.normals[t[2]]}, u, v, form)) continue;
    const double weight = norm(area);
    for (const std::int32_t corner : t) {
      tensors[corner].add(weight * form[0], u, u);
      tensors[corner].add(2 * weight * form[1], u, v);
      tensors[corner].add(weight * form[2], v, v);
      weights[corner] += weight;
    }
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    PrincipalCurvatures found{0, 0, true};
    if (weights[i] > 0) {
      found = principal(tensors[i], shape.normals[i]);
      found.largest /= weights[i], found.smallest /= weights[i];
    }
    shape.curvatures.push_back(found);
  }
  bound_by_quartile(triangles, shape.curvatures);
  return shape;
}

}  // namespace aeroloom::cad
