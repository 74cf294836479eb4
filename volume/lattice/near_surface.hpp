/// The part of the surface near some points: how far it is, and which region it bounds there.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "volume/lattice/boundary_distance.hpp"
#include "volume/lattice/surface_near_blocks.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// Triangles of any part of the surface; it need not be closed. Immutable.
class NearSurface {
public:
  explicit NearSurface(std::span<const SurfaceTriangle> triangles);
  NearSurface(const NearSurface&) = delete;
  NearSurface& operator=(const NearSurface&) = delete;

  bool empty() const { return _triangles.empty(); }
  std::span<const geometry::Vec3> points() const { return _points; }
  /// In the order they were given.
  std::span<const BoundaryDistance::Triangle> triangles() const { return _triangles; }
  /// Queries of distance; not to be used when empty.
  const BoundaryDistance& distance() const { return *_distance; }

  /// The region that a point off the surface lies in, mesh::no_region outside of all. `nearest` is the
  /// triangle nearest to it: nothing lies between. Where that is met in an edge or vertex, what the way to
  /// its inside crosses first decides, by exact signs, so any number of sheets may meet there. Nothing when
  /// the point sees all triangles there edge-on.
  std::optional<mesh::RegionId> region_at(geometry::Vec3 p, const BoundaryDistance::Nearest& nearest) const;

  /// The region of a point, told by what the way from p to q, a point inside a triangle, crosses first. All
  /// triangles must be known that it may cross. Nothing where it meets one in an edge or vertex.
  std::optional<mesh::RegionId> region_towards(geometry::Vec3 p, geometry::Vec3 q,
                                               std::int32_t triangle) const;

private:
  struct Sight {
    std::int32_t triangle = -1;
    int side = 0;  ///< of the triangle that the point is on
  };
  /// The triangle that is crossed first on the way from p to q, a point of `target`.
  std::optional<Sight> first_on_way(geometry::Vec3 p, geometry::Vec3 q, std::int32_t target,
                                    std::span<const std::int32_t> candidates) const;
  int side_of(geometry::Vec3 p, std::int32_t triangle) const;
  std::vector<std::int32_t> around(std::int32_t triangle) const;
  mesh::RegionId region_of(const Sight& sight) const;

  std::vector<geometry::Vec3> _points;
  std::vector<BoundaryDistance::Triangle> _triangles;
  std::vector<mesh::RegionId> _front, _back;         ///< per triangle
  std::vector<std::int32_t> _first_around, _around;  ///< triangles around each point
  std::optional<BoundaryDistance> _distance;
};

}  // namespace aeroloom::volume
