/// Cuts triangles of surfaces that touch along each other, so that they meet in common points and sides.
///
/// All cuts are exact (CGAL): triangles in one plane are cut by one constrained Delaunay triangulation, so
/// that what two of them cover has equal triangles in both. Only new points are rounded.
#pragma once

#include "geometry/half_edges.hpp"
#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::geometry {

struct ImprintedTriangles {
  std::vector<Vec3> points;                ///< the given ones first; new ones may be equal to others
  std::vector<TriangleCorners> triangles;  ///< by source, turned as it
  std::vector<std::int32_t> sources;       ///< per triangle, the one that it is a part of
  std::size_t cut = 0;                     ///< number of triangles that are more than one now
  /// A pair that crosses: a segment lies inside of both. Nothing is cut then.
  std::optional<std::array<std::int32_t, 2>> crossing;
};

/// `contacts` are all pairs that meet elsewhere than in common points and sides. No triangle may be flat. The
/// result depends only on the arguments.
ImprintedTriangles imprint_triangles(std::span<const Vec3> points, std::span<const TriangleCorners> triangles,
                                     std::span<const std::array<std::int32_t, 2>> contacts);

}  // namespace aeroloom::geometry
