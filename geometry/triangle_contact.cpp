#include "geometry/triangle_contact.hpp"

#include "geometry/predicates.hpp"

#include <algorithm>
#include <cmath>

namespace aeroloom::geometry {
namespace {

Vec2 without_axis(Vec3 p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

// The two triangles have the edge pq. Coplanar ones overlap when their third vertices lie on one side of it.
bool folded_over_edge(Vec3 p, Vec3 q, Vec3 a, Vec3 b) {
  if (orient3d(p, q, a, b) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec2 start = without_axis(p, axis), end = without_axis(q, axis);
    const int side_a = orient2d(start, end, without_axis(a, axis));
    const int side_b = orient2d(start, end, without_axis(b, axis));
    if (side_a * side_b != 0) return side_a == side_b;
  }
  return true;
}

/// Places of which the mean is wanted.
struct MeanPlace {
  Vec3 sum;
  int count = 0;

  void add(Vec3 p) { sum += p, ++count; }
  Vec3 mean() const { return sum / count; }
};

/// Whether a point of the triangle's plane is in the triangle, up to rounding.
bool is_in_triangle(Vec3 p, const Vec3 (&t)[3], Vec3 normal) {
  constexpr double rounding = 1e-12;  // of the triangle's area
  const double least = -rounding * dot(normal, normal);
  for (int k = 0; k < 3; ++k)
    if (dot(cross(t[(k + 1) % 3] - t[k], p - t[k]), normal) < least) return false;
  return true;
}

/// Where sides of one triangle pass through the other.
void add_piercings(const Vec3 (&sides)[3], const Vec3 (&t)[3], MeanPlace& places) {
  const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
  for (int k = 0; k < 3; ++k) {
    const Vec3 p = sides[k], q = sides[(k + 1) % 3];
    const double above_p = dot(normal, p - t[0]), above_q = dot(normal, q - t[0]);
    if (above_q == 0 || above_p * above_q > 0) continue;  // an end counts for the side that begins there
    const Vec3 at = p + above_p / (above_p - above_q) * (q - p);
    if (is_in_triangle(at, t, normal)) places.add(at);
  }
}

struct NearestPlace {
  double distance;
  Vec3 middle;
};

/// Of two segments.
NearestPlace nearest_of(Vec3 p, Vec3 q, Vec3 r, Vec3 s) {
  const Vec3 u = q - p, v = s - r, w = p - r;
  const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), area = uu * vv - uv * uv;
  const auto clamped = [](double t) { return std::clamp(t, 0.0, 1.0); };
  double on_first = area > 0 ? clamped((uv * dot(v, w) - vv * dot(u, w)) / area) : 0;
  const double on_second = vv > 0 ? clamped((uv * on_first + dot(v, w)) / vv) : 0;
  if (uu > 0) on_first = clamped((uv * on_second - dot(u, w)) / uu);
  const Vec3 a = p + on_first * u, b = r + on_second * v;
  return {distance(a, b), 0.5 * (a + b)};
}

/// Where corners of one triangle are nearest to the inside of the other.
void look_below_corners(const Vec3 (&corners)[3], const Vec3 (&t)[3], NearestPlace& nearest) {
  const Vec3 normal = cross(t[1] - t[0], t[2] - t[0]);
  const double length = norm(normal);
  if (length == 0) return;
  for (const Vec3 p : corners) {
    const double above = dot(normal, p - t[0]) / length;
    const Vec3 foot = p - above / length * normal;
    if (std::abs(above) < nearest.distance && is_in_triangle(foot, t, normal))
      nearest = {std::abs(above), 0.5 * (p + foot)};
  }
}

}  // namespace

Vec3 place_of_meeting(const Vec3 (&a)[3], const Vec3 (&b)[3]) {
  MeanPlace places;
  add_piercings(a, b, places);
  add_piercings(b, a, places);
  if (places.count > 0) return places.mean();
  NearestPlace nearest = nearest_of(a[0], a[1], b[0], b[1]);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const NearestPlace here = nearest_of(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]);
      if (here.distance < nearest.distance) nearest = here;
    }
  }
  look_below_corners(a, b, nearest);
  look_below_corners(b, a, nearest);
  return nearest.middle;
}

bool meet_wrongly(const Vec3 (&a)[3], const Vec3 (&b)[3], const CommonCorners& common) {
  switch (common.count) {
    case 0:
      return triangles_intersect(a, b);
    case 1: {
      // Two triangles that share more than their vertex do so up to the opposite edge of one of them.
      const int i = common.first[0], j = common.second[0];
      return segment_meets_triangle(a[(i + 1) % 3], a[(i + 2) % 3], b) ||
             segment_meets_triangle(b[(j + 1) % 3], b[(j + 2) % 3], a);
    }
    case 2:
      return folded_over_edge(a[common.first[0]], a[common.first[1]],
                              a[3 - common.first[0] - common.first[1]],
                              b[3 - common.second[0] - common.second[1]]);
    default:
      return true;
  }
}

}  // namespace aeroloom::geometry
