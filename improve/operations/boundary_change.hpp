/// Limits on changes of the boundary, so that it stays a smooth image of its CAD face.
#pragma once

#include "geometry/half_edges.hpp"
#include "improve/tets/tet_mesh.hpp"

#include <array>
#include <span>

namespace aeroloom::improve {

/// Corners of a boundary triangle, counter-clockwise seen from outside.
using geometry::TriangleCorners;
using TrianglePoints = std::array<Vec3, 3>;

inline TrianglePoints points_of(const TetMesh& mesh, const TriangleCorners& corners) {
  return {mesh.point(corners[0]), mesh.point(corners[1]), mesh.point(corners[2])};
}

/// Largest ratio of a new boundary edge to the longest old one. Chosen, not measured.
inline constexpr double most_growth = 1.5;

/// Whether new boundary triangles may replace old ones. Each new normal is within 20 degrees of all old ones,
/// and no edge is longer than 1.5 times the longest old one. The worst mean ratio is at least the old one or
/// 0.5. All corners stay on the CAD face, so edge lengths bound the chordal error.
bool is_gentle_change(std::span<const TrianglePoints> before, std::span<const TrianglePoints> after);

/// Finds edges of the boundary, its fixed parts included.
class BoundaryEdges {
public:
  /// Whether there is one between two vertices.
  bool exists(TetMesh& mesh, LocalIndex from, LocalIndex to);

private:
  std::vector<LocalIndex> _star;
};

}  // namespace aeroloom::improve
