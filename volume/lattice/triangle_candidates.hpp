/// The triangles near a group of points, for many distance queries.
#pragma once

#include "volume/lattice/boundary_distance.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace aeroloom::volume {

/// The distance that points keep from a triangle: its mean edge, clamped to bounds, times a factor.
struct Clearance {
  double factor, smallest_edge, largest_edge;

  double from(double mean_edge) const { return factor * std::clamp(mean_edge, smallest_edge, largest_edge); }
};

/// Triangles that may be near the points of a box. Memory is reused from one group of points to the next.
class TriangleCandidates {
public:
  /// Collects all triangles nearer than `radius` to a point of the box. Some others may be among them.
  void collect(const BoundaryDistance& boundary, const geometry::Box& box, double radius);

  /// Whether a triangle is nearer to p than its clearance. p is in the box, clearances are at most `radius`.
  bool any_nearer(geometry::Vec3 p, const Clearance& clearance) const;
  /// Whether a corner of a triangle is nearer to p, in the box, than `distance`, which is at most `radius`.
  bool any_corner_nearer(geometry::Vec3 p, double distance) const;
  /// The triangle nearest to p, in the box; nothing if none is nearer than `radius`.
  std::optional<BoundaryDistance::Nearest> nearest(geometry::Vec3 p) const;

private:
  /// A ball that contains a triangle.
  struct Ball {
    geometry::Vec3 center;
    double radius;
  };

  double _radius = 0;
  std::vector<Ball> _balls;
  std::vector<BoundaryDistance::Measured> _triangles;  ///< in the balls
};

}  // namespace aeroloom::volume
