/// Distance to a triangulated boundary.
#pragma once

#include "geometry/box_tree.hpp"
#include "geometry/vec.hpp"
#include "mesh/piece.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// Triangles in a tree of boxes, at least one. Refers to the arrays it was built from.
/// Queries do not allocate. Immutable.
class BoundaryDistance {
public:
  using Triangle = std::array<mesh::LocalIndex, 3>;

  BoundaryDistance(std::span<const geometry::Vec3> points, std::span<const Triangle> triangles);

  /// The nearest triangle to a point.
  struct Nearest {
    double distance = 0;
    std::int32_t triangle = -1;
    bool in_face = false;  ///< the foot point lies inside the triangle, on none of its edges
  };
  /// `guess` is a triangle thought to be near, -1 for none; it changes the speed, not the distance. Triangles
  /// not nearer than `range` are not seen: with none nearer, the triangle is -1 and the distance `range`.
  Nearest nearest(geometry::Vec3 p, std::int32_t guess = -1, double range = 1e150) const;

  /// The point of one triangle that is nearest to p, and how far it is.
  geometry::Vec3 foot_point(geometry::Vec3 p, std::int32_t triangle) const;
  double distance_to(geometry::Vec3 p, std::int32_t triangle) const {
    return distance(p, foot_point(p, triangle));
  }

  /// Whether a triangle lies nearer to p than its own limit; `limit(t)` is at most `largest_limit`.
  template <class Limit>
  bool any_nearer(geometry::Vec3 p, double largest_limit, const Limit& limit) const;

  /// Mean edge length of a triangle.
  double mean_edge(std::int32_t triangle) const { return _mean_edges[triangle]; }
  const geometry::Box& box() const { return _tree.nodes().front().box; }

  /// Calls `visit(a, b)`, a < b, for all pairs of triangles whose boxes overlap.
  void for_each_overlapping_pair(const std::function<void(std::int32_t, std::int32_t)>& visit) const;

private:
  /// Corners of the triangles in the order of the leaves (slots).
  struct Corners {
    geometry::Vec3 a, b, c;
  };

  static double squared_distance(geometry::Vec3 p, const Corners& triangle, bool& in_face);
  static double squared_distance(geometry::Vec3 p, const geometry::Box& box);
  geometry::Vec3 corner(std::int32_t triangle, int k) const { return _points[_triangles[triangle][k]]; }

  std::span<const geometry::Vec3> _points;
  std::span<const Triangle> _triangles;
  std::vector<double> _mean_edges;
  geometry::BoxTree _tree;
  std::vector<std::int32_t> _slot;  ///< place of each triangle in the tree's order
  std::vector<Corners> _corners;
};

template <class Limit>
bool BoundaryDistance::any_nearer(geometry::Vec3 p, double largest_limit, const Limit& limit) const {
  bool found = false;
  const auto enters = [&](const geometry::Box& box) {
    return !found && squared_distance(p, box) < largest_limit * largest_limit;
  };
  _tree.search(enters, [&](std::int32_t slot) {
    if (found) return;
    const double allowed = limit(_tree.order()[slot]);
    bool in_face = false;
    found = squared_distance(p, _corners[slot], in_face) < allowed * allowed;
  });
  return found;
}

inline double BoundaryDistance::squared_distance(geometry::Vec3 p, const geometry::Box& box) {
  const double dx = std::max({box.low.x - p.x, 0.0, p.x - box.high.x});
  const double dy = std::max({box.low.y - p.y, 0.0, p.y - box.high.y});
  const double dz = std::max({box.low.z - p.z, 0.0, p.z - box.high.z});
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace aeroloom::volume
