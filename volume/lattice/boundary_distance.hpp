/// Distance to a triangulated boundary.
#pragma once

#include "geometry/box_tree.hpp"
#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// Finds distances to triangles, at least one, with a tree of boxes. Refers to the arrays it was built from.
/// Queries do not allocate memory. Immutable.
class BoundaryDistance {
public:
  using Triangle = std::array<mesh::LocalIndex, 3>;

  BoundaryDistance(std::span<const geometry::Vec3> points, std::span<const Triangle> triangles);

  /// The nearest triangle to a point.
  struct Nearest {
    double distance = 0;
    std::int32_t triangle = -1;
    bool in_face = false;  ///< the nearest point is inside the triangle, on none of its edges
  };
  /// `guess` is a triangle that may be near, or -1. It changes the speed, not the distance.
  Nearest nearest(geometry::Vec3 p, std::int32_t guess = -1) const;

  /// The point of a triangle that is nearest to p, and its distance to p.
  geometry::Vec3 foot_point(geometry::Vec3 p, std::int32_t triangle) const;
  double distance_to(geometry::Vec3 p, std::int32_t triangle) const {
    return distance(p, foot_point(p, triangle));
  }

  /// Mean edge length of a triangle.
  double mean_edge(std::int32_t triangle) const { return _mean_edges[_slot[triangle]]; }
  const geometry::Box& box() const { return _tree.nodes().front().box; }

  /// A triangle with the data for distance queries.
  struct Corners {
    geometry::Vec3 a, b, c;
  };
  struct Measured {
    Corners corners;
    double mean_edge;
    std::int32_t triangle;
  };
  /// Calls `visit(measured)` for the triangles of all leaves of the tree that overlap a box.
  template <class Visit>
  void for_each_in(const geometry::Box& box, const Visit& visit) const {
    _tree.search([&](const geometry::Box& node) { return node.overlaps(box); },
                 [&](std::int32_t slot) {
                   visit(Measured{_corners[slot], _mean_edges[slot], _tree.order()[slot]});
                 });
  }
  /// Whether a leaf of the tree overlaps a box.
  bool any_in(const geometry::Box& box) const;

  /// The squared distance to a triangle, and whether the nearest point is inside it, on none of its edges.
  struct SquaredDistance {
    double squared;
    bool in_face;
  };
  static SquaredDistance squared_distance(geometry::Vec3 p, const Corners& triangle);
  static double squared_distance(geometry::Vec3 p, const geometry::Box& box);

  /// Calls `visit(a, b)`, a < b, for all pairs of triangles whose boxes overlap.
  void for_each_overlapping_pair(const std::function<void(std::int32_t, std::int32_t)>& visit) const;

private:
  geometry::Vec3 corner(std::int32_t triangle, int k) const { return _points[_triangles[triangle][k]]; }

  std::span<const geometry::Vec3> _points;
  std::span<const Triangle> _triangles;
  geometry::BoxTree _tree;
  std::vector<std::int32_t> _slot;  ///< index of each triangle in the tree's order
  std::vector<Corners> _corners;    ///< in the tree's order
  std::vector<double> _mean_edges;  ///< in the tree's order
};

inline double BoundaryDistance::squared_distance(geometry::Vec3 p, const geometry::Box& box) {
  const double dx = std::max({box.low.x - p.x, 0.0, p.x - box.high.x});
  const double dy = std::max({box.low.y - p.y, 0.0, p.y - box.high.y});
  const double dz = std::max({box.low.z - p.z, 0.0, p.z - box.high.z});
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace aeroloom::volume
