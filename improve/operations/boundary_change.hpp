/// How much the boundary may change where tetrahedra on it are improved: it stays a smooth image of the CAD
/// face.
#pragma once

#include "geometry/half_edges.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <span>

namespace aeroloom::improve {

/// Of a boundary triangle counter-clockwise seen from outside.
using geometry::TriangleCorners;
using TrianglePoints = std::array<Vec3, 3>;

inline TrianglePoints points_of(const TetMesh& mesh, const TriangleCorners& corners) {
  return {mesh.point(corners[0]), mesh.point(corners[1]), mesh.point(corners[2])};
}

/// Of edges of the boundary, over the longest one before. Chosen, not measured.
inline constexpr double most_growth = 1.5;

/// Whether new triangles may take the place of old ones: no normal turns by more than 20 degrees against any
/// old one, no edge is longer than 1.5 times the longest one before, and the worst shape is at least as good
/// as before or 0.5 (of a mean ratio). All corners stay on the CAD face, so the chordal error stays that of
/// edges of such lengths.
bool is_gentle_change(std::span<const TrianglePoints> before, std::span<const TrianglePoints> after);

/// Edges of the boundary, also of its parts that must not change.
class BoundaryEdges {
public:
  /// Whether there is one between two vertices.
  bool exists(TetMesh& mesh, LocalIndex from, LocalIndex to);

private:
  std::vector<LocalIndex> _star;
};

}  // namespace aeroloom::improve
