/// The surface triangles that a rank has: distances to them, and the regions on either side.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "volume/lattice/boundary_distance.hpp"
#include "volume/lattice/surface_triangles.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// A part of the surface. It need not be closed. Immutable.
class LocalSurface {
public:
  explicit LocalSurface(std::span<const SurfaceTriangle> triangles);
  LocalSurface(const LocalSurface&) = delete;
  LocalSurface& operator=(const LocalSurface&) = delete;

  bool empty() const { return _triangles.empty(); }
  std::span<const geometry::Vec3> points() const { return _points; }
  /// In the order in which they were given.
  std::span<const BoundaryDistance::Triangle> triangles() const { return _triangles; }
  /// For distance queries. Call it only if there are triangles.
  const BoundaryDistance& distance() const { return *_distance; }

  /// The region of a point off the surface; mesh::no_region outside all regions. `nearest` is the triangle
  /// nearest to it. If the nearest point is on an edge or a vertex, the line from p to a point inside the
  /// triangle decides, by the first triangle that it crosses. Signs are exact, so any number of sheets may
  /// meet there. Nothing if the point lies in the planes of all these triangles.
  std::optional<mesh::RegionId> region_at(geometry::Vec3 p, const BoundaryDistance::Nearest& nearest) const;

  /// The region of p, from the first triangle that the line from p to q crosses; q is inside `triangle`. The
  /// surface must contain all triangles that the line can cross. Nothing if it meets an edge or a vertex.
  std::optional<mesh::RegionId> region_towards(geometry::Vec3 p, geometry::Vec3 q,
                                               std::int32_t triangle) const;

private:
  struct Sight {
    std::int32_t triangle = -1;
    int side = 0;  ///< of the triangle on which the point is: the sign of orient3d
  };
  /// The triangle that the line from p to q crosses first; q is a point of `target`.
  std::optional<Sight> first_on_way(geometry::Vec3 p, geometry::Vec3 q, std::int32_t target,
                                    std::span<const std::int32_t> candidates) const;
  /// The region on both sides of all these triangles, if they are of baffles in it.
  std::optional<mesh::RegionId> common_region(std::span<const std::int32_t> triangles) const;
  int side_of(geometry::Vec3 p, std::int32_t triangle) const;
  std::vector<std::int32_t> around(std::int32_t triangle) const;
  mesh::RegionId region_of(const Sight& sight) const;

  std::vector<geometry::Vec3> _points;
  std::vector<BoundaryDistance::Triangle> _triangles;
  std::vector<mesh::RegionId> _inside, _outside;     ///< per triangle
  std::vector<std::int32_t> _first_around, _around;  ///< the triangles at each point
  std::optional<BoundaryDistance> _distance;
};

}  // namespace aeroloom::volume
