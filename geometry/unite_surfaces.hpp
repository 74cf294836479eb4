/// The union of closed surfaces of triangles.
///
/// Intersections are found with exact predicates and constructed exactly (CGAL's corefinement); only the last
/// union is rounded, so that triangles of the result may cross by as little as that.
#pragma once

#include "geometry/half_edges.hpp"
#include "geometry/vec.hpp"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace aeroloom::geometry {

/// Triangles that meet in common points and sides only, two to a side; normals point out of what they
/// enclose.
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
  std::vector<TriangleSource> sources;  ///< per triangle, that which it lies in
};

/// A union that is none. The message says why; no place, no remedy.
class UnionError : public std::runtime_error {
public:
  UnionError(std::size_t surface, const std::string& why) : std::runtime_error(why), _surface(surface) {}
  /// That which could not be united with those before it.
  std::size_t surface() const { return _surface; }

private:
  std::size_t _surface;
};

/// Unites one or more surfaces, one after the other. Of each step the volumes must add up: that of both parts
/// less what they share is that of the union, to `volume_tolerance` of the parts. Throws UnionError where a
/// union does not bound a volume, as of surfaces that touch at a point or along a line, or where volumes do
/// not add up. The result is a function of the surfaces and their order.
UnitedSurface unite_surfaces(const std::vector<ClosedSurface>& surfaces, double volume_tolerance);

}  // namespace aeroloom::geometry
