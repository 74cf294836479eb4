#include "mesh/triangle_contact.hpp"

#include "geometry/predicates.hpp"

namespace aeroloom::mesh {
namespace {

using geometry::Vec2;
using geometry::Vec3;

Vec2 without_axis(Vec3 p, int axis) {
  return {p[(axis + 1) % 3], p[(axis + 2) % 3]};
}

// The two triangles have the edge pq. Coplanar ones overlap when their third vertices lie on one side of it.
bool folded_over_edge(Vec3 p, Vec3 q, Vec3 a, Vec3 b) {
  if (geometry::orient3d(p, q, a, b) != 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec2 start = without_axis(p, axis), end = without_axis(q, axis);
    const int side_a = geometry::orient2d(start, end, without_axis(a, axis));
    const int side_b = geometry::orient2d(start, end, without_axis(b, axis));
    if (side_a * side_b != 0) return side_a == side_b;
  }
  return true;
}

}  // namespace

bool meet_wrongly(const NamedTriangle& a, const NamedTriangle& b) {
  int common = 0, in_a[3], in_b[3];
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (common < 3 && a.names[i] == b.names[j]) in_a[common] = i, in_b[common++] = j;
    }
  }
  switch (common) {
    case 0:
      return geometry::triangles_intersect(a.points, b.points);
    case 1: {
      // Two triangles that share more than their vertex do so up to the opposite edge of one of them.
      const int i = in_a[0], j = in_b[0];
      return geometry::segment_meets_triangle(a.points[(i + 1) % 3], a.points[(i + 2) % 3], b.points) ||
             geometry::segment_meets_triangle(b.points[(j + 1) % 3], b.points[(j + 2) % 3], a.points);
    }
    case 2:
      return folded_over_edge(a.points[in_a[0]], a.points[in_a[1]], a.points[3 - in_a[0] - in_a[1]],
                              b.points[3 - in_b[0] - in_b[1]]);
    default:
      return true;
  }
}

}  // namespace aeroloom::mesh
