/// Exact geometric predicates. They compute in floating point where rounding cannot change the sign, and
/// exactly elsewhere. Signs are -1, 0 or 1.
#pragma once

#include "geometry/vec.hpp"

#include <cmath>

namespace aeroloom::geometry {

/// 1 when (a,b,c) turn counter-clockwise, -1 clockwise, 0 collinear.
int orient2d(Vec2 a, Vec2 b, Vec2 c);
/// 1 when d lies on the side to which the counter-clockwise normal of (a,b,c) points: the tetrahedron
/// (a,b,c,d) has positive volume in VTK's order. 0 when coplanar.
int orient3d(Vec3 a, Vec3 b, Vec3 c, Vec3 d);
/// Whether orient3d is positive. Exact; faster where rounding cannot matter.
inline bool has_positive_volume(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  const auto sum = [](Vec3 e) { return std::abs(e.x) + std::abs(e.y) + std::abs(e.z); };
  const double bound = 1e-14 * sum(b - a) * sum(c - a) * sum(d - a);
  return volume6(a, b, c, d) > bound || orient3d(a, b, c, d) > 0;
}
/// For (a,b,c) counter-clockwise: 1 when d is inside their circumcircle, 0 on it, -1 outside.
int in_circle(Vec2 a, Vec2 b, Vec2 c, Vec2 d);
/// Whether the closed triangles share a point. Triangles may be coplanar or degenerate (segments, points).
/// Exact.
bool triangles_intersect(const Vec3 (&a)[3], const Vec3 (&b)[3]);
/// Whether the closed segment pq meets the closed triangle. Exact.
bool segment_meets_triangle(Vec3 p, Vec3 q, const Vec3 (&triangle)[3]);

}  // namespace aeroloom::geometry
