/// The triangles near a few points that lie close together, for many questions of distance.
#pragma once

#include "volume/lattice/boundary_distance.hpp"

#include <algorithm>
#include <optional>
#include <vector>

namespace aeroloom::volume {

/// How far points keep off a triangle: its mean edge, within bounds, times a factor.
struct Clearance {
  double factor, smallest_edge, largest_edge;

  double from(double mean_edge) const { return factor * std::clamp(mean_edge, smallest_edge, largest_edge); }
};

/// Collected anew for each group of points, in memory that is kept.
class NearTriangles {
public:
  /// All triangles nearer than `radius` to a point of the box, and some others.
  void collect(const BoundaryDistance& boundary, const geometry::Box& box, double radius);

  /// Whether a triangle lies nearer to p, a point of the box, than the clearance from it, at most `radius`.
  bool any_nearer(geometry::Vec3 p, const Clearance& clearance) const;
  /// Whether a corner of a triangle lies nearer to p, a point of the box, than `distance`, at most `radius`.
  bool any_corner_nearer(geometry::Vec3 p, double distance) const;
  /// The nearest triangle to p, a point of the box; nothing where it is not nearer than `radius`.
  std::optional<BoundaryDistance::Nearest> nearest(geometry::Vec3 p) const;

private:
  /// A ball around a triangle.
  struct Ball {
    geometry::Vec3 center;
    double radius;
  };

  double _radius = 0;
  std::vector<Ball> _balls;
  std::vector<BoundaryDistance::Measured> _triangles;  ///< in them
};

}  // namespace aeroloom::volume
