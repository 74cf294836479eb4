/// Distance to a triangulated boundary.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/piece.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace aeroloom::volume {

/// A tree of boxes over triangles, at least one. Refers to the arrays it was built from.
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
  const geometry::Box& box() const { return _nodes.front().box; }

  /// Calls `visit(a, b)`, a < b, for all pairs of triangles whose boxes overlap.
  void for_each_overlapping_pair(const std::function<void(std::int32_t, std::int32_t)>& visit) const;

private:
  struct Node {
    geometry::Box box;
    std::int32_t first = 0, count = 0;  ///< slots of a leaf; count 0: inner node
    std::int32_t right = 0;             ///< second child of an inner node; the first one follows the node
  };
  /// Corners of the triangles in the order of the leaves (slots).
  struct Corners {
    geometry::Vec3 a, b, c;
  };

  std::int32_t build(std::int32_t first, std::int32_t last);
  void summarise(std::int32_t first, std::int32_t last);
  static double squared_distance(geometry::Vec3 p, const Corners& triangle, bool& in_face);
  static double squared_distance(geometry::Vec3 p, const geometry::Box& box);
  geometry::Vec3 corner(std::int32_t triangle, int k) const { return _points[_triangles[triangle][k]]; }

  std::span<const geometry::Vec3> _points;
  std::span<const Triangle> _triangles;
  std::vector<double> _mean_edges;
  std::vector<std::int32_t> _order;  ///< triangle of each slot
  std::vector<std::int32_t> _slot;   ///< slot of each triangle
  std::vector<Corners> _corners;
  std::vector<Node> _nodes;
};

template <class Limit>
bool BoundaryDistance::any_nearer(geometry::Vec3 p, double largest_limit, const Limit& limit) const {
  std::int32_t stack[64];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::int32_t index = stack[--depth];
    const Node& node = _nodes[index];
    if (squared_distance(p, node.box) >= largest_limit * largest_limit) continue;
    if (node.count == 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (std::int32_t i = node.first; i < node.first + node.count; ++i) {
      const double allowed = limit(_order[i]);
      bool in_face = false;
      if (squared_distance(p, _corners[i], in_face) < allowed * allowed) return true;
    }
  }
  return false;
}

inline double BoundaryDistance::squared_distance(geometry::Vec3 p, const geometry::Box& box) {
  const double dx = std::max({box.low.x - p.x, 0.0, p.x - box.high.x});
  const double dy = std::max({box.low.y - p.y, 0.0, p.y - box.high.y});
  const double dz = std::max({box.low.z - p.z, 0.0, p.z - box.high.z});
  return dx * dx + dy * dy + dz * dz;
}

}  // namespace aeroloom::volume
