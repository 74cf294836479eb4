/// The union of closed surfaces of triangles.
///
/// Intersections are exact (CGAL's corefinement). Only the last union is rounded, so triangles of the result
/// may cross by rounding errors.
#pragma once

#include "geometry/half_edges.hpp"
#include "geometry/vec.hpp"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace aeroloom::geometry {

/// Triangles that meet only in common points and sides, two at each side. Normals point out of the enclosed
/// volume.
struct ClosedSurface {
  std::vector<Vec3> points;
  std::vector<TriangleCorners> triangles;
};

/// A triangle of one of several surfaces.
struct TriangleSource {
  std::int32_t surface = 0, triangle = 0;
  friend auto operator<=>(const TriangleSource&, const TriangleSource&) = default;
};

struct UnitedSurface {
  ClosedSurface surface;                ///< points by coordinates, triangles by source
  std::vector<TriangleSource> sources;  ///< per triangle, the one that contains it
};

/// Surfaces that cannot be united. The message has the reason, but no place and no remedy.
class UnionError : public std::runtime_error {
public:
  UnionError(std::size_t surface, const std::string& why) : std::runtime_error(why), _surface(surface) {}
  /// The surface that could not be united with those before it.
  std::size_t surface() const { return _surface; }

private:
  std::size_t _surface;
};

/// Unites one or more surfaces, one after the other. After each step the volume of the union must be that of
/// both parts minus their intersection, to `volume_tolerance` of the parts. Throws UnionError if volumes do
/// not add up, or if a union does not bound a volume, as when surfaces touch at a point or along a line. The
/// result depends only on the surfaces and their order.
UnitedSurface unite_surfaces(const std::vector<ClosedSurface>& surfaces, double volume_tolerance);

}  // namespace aeroloom::geometry
