#include "geometry/triangle_contact.hpp"

#include "geometry/predicates.hpp"

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

}  // namespace

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
