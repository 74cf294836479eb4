#include "improve/boundary_change.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::improve {
namespace {

const double least_cosine = std::cos(20 * std::numbers::pi / 180);
constexpr double most_growth = 1.5;     // of edges
constexpr double decent_quality = 0.3;  // of a triangle: below this it must not get worse

struct Shape {
  Vec3 normal;         ///< unit length
  double longest = 0;  ///< edge, squared
  double quality = 0;  ///< mean ratio: 1 for an equilateral triangle
};

Shape shape_of(const TetMesh& mesh, const TriangleCorners& corners) {
  const Vec3 a = mesh.point(corners[0]), b = mesh.point(corners[1]), c = mesh.point(corners[2]);
  const Vec3 twice_area = cross(b - a, c - a);
  const double lengths[3] = {dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)};
  const double area = norm(twice_area);
  Shape shape;
  shape.longest = *std::max_element(lengths, lengths + 3);
  shape.quality = 2 * std::numbers::sqrt3 * area / (lengths[0] + lengths[1] + lengths[2]);
  if (area > 0) shape.normal = (1 / area) * twice_area;
  return shape;
}

}  // namespace

bool is_gentle_change(const TetMesh& mesh, std::span<const TriangleCorners> before,
                      std::span<const TriangleCorners> after) {
  double longest = 0, worst = 1;
  for (const TriangleCorners& old : before) {
    const Shape shape = shape_of(mesh, old);
    longest = std::max(longest, shape.longest);
    worst = std::min(worst, shape.quality);
  }
  for (const TriangleCorners& fresh : after) {
    const Shape shape = shape_of(mesh, fresh);
    if (shape.longest > most_growth * most_growth * longest) return false;
    if (shape.quality < std::min(worst, decent_quality)) return false;
    for (const TriangleCorners& old : before) {
      if (dot(shape.normal, shape_of(mesh, old).normal) < least_cosine) return false;
    }
  }
  return true;
}

bool BoundaryEdges::exists(TetMesh& mesh, LocalIndex from, LocalIndex to) {
  mesh.collect_star(from, _star);
  for (const LocalIndex t : _star) {
    const Corners& c = mesh.corners(t);
    const int there = mesh.local_vertex(t, to);
    if (c[there] != to) continue;
    const int here = mesh.local_vertex(t, from);
    for (int f = 0; f < 4; ++f) {
      if (f != here && f != there && mesh.mate(4 * t + f) < 0) return true;
    }
  }
  return false;
}

}  // namespace aeroloom::improve
