#include "improve/operations/boundary_change.hpp"

#include "mesh/quality/quality.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::improve {
namespace {

// No normal turns by more than 20 degrees (docs/improvement.md): what turns more shows as a facet of its own.
// Chosen, not measured.
const double least_cosine = std::cos(20 * std::numbers::pi / 180);
constexpr double decent_quality =
    0.5;  // of a triangle: below this it must not get worse; chosen, not measured

struct Shape {
  Vec3 normal;         ///< unit length
  double longest = 0;  ///< edge, squared
  double quality = 0;  ///< mean ratio: 1 for an equilateral triangle
};

Shape shape_of(const TrianglePoints& points) {
  const auto& [a, b, c] = points;
  return {normalized(cross(b - a, c - a)),
          std::max({dot(b - a, b - a), dot(c - b, c - b), dot(a - c, a - c)}),
          mesh::triangle_mean_ratio(a, b, c)};
}

}  // namespace

bool is_gentle_change(std::span<const TrianglePoints> before, std::span<const TrianglePoints> after) {
  double longest = 0, worst = 1;
  for (const TrianglePoints& old : before) {
    const Shape shape = shape_of(old);
    longest = std::max(longest, shape.longest);
    worst = std::min(worst, shape.quality);
  }
  for (const TrianglePoints& fresh : after) {
    const Shape shape = shape_of(fresh);
    if (shape.longest > most_growth * most_growth * longest) return false;
    if (shape.quality < std::min(worst, decent_quality)) return false;
    for (const TrianglePoints& old : before) {
      if (dot(shape.normal, shape_of(old).normal) < least_cosine) return false;
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
      if (f != here && f != there && mesh.twin(4 * t + f) < 0) return true;
    }
  }
  return false;
}

}  // namespace aeroloom::improve
