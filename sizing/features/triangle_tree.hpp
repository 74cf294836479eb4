/// Triangles in a tree of boxes: which of them overlap a cube, and whether a point is inside the surface.
#pragma once

#include "geometry/box_tree.hpp"
#include "geometry/vec.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace aeroloom::sizing {

using Triangle = std::array<geometry::Vec3, 3>;

struct LongestEdge {
  int from = 0;  ///< its first corner; the next corner ends it
  double length = 0;
};
LongestEdge longest_edge(const Triangle& t);

inline double area_of(const Triangle& t) {
  return 0.5 * norm(cross(t[1] - t[0], t[2] - t[0]));
}

/// The halves of a triangle, cut in the middle of the edge from that corner to the next one.
std::array<Triangle, 2> bisect(const Triangle& t, int from);

/// A line that cannot pass between triangles which share an edge or a corner. Each corner is sheared to a
/// frame with the line as third axis. Shared corners have the same coordinates there. So the side of an edge
/// on which the line passes has an exact sign. Woop, Benthin and Wald, J. Computer Graphics Techniques 2(1),
/// 2013, https://jcgt.org/published/0002/01/05/.
class ShearedLine {
public:
  /// `direction`: a unit vector.
  ShearedLine(geometry::Vec3 point, geometry::Vec3 direction);

  /// The distance along the line to a triangle, border included; negative behind the point. Infinite if the
  /// line misses the triangle, meets it in the point, or lies in its plane.
  double place_of(const Triangle& t) const;

private:
  geometry::Vec3 sheared(geometry::Vec3 p) const {
    const geometry::Vec3 from = p - _point;
    const double along = from[_axis];
    return {from[_first] - _shear.x * along, from[_second] - _shear.y * along, _scale * along};
  }

  geometry::Vec3 _point;
  int _axis, _first, _second;  // the axis that is nearest to the line, and the others
  geometry::Vec2 _shear;
  double _scale;
};

/// A triangle surface for estimates. It uses floating point, and facets need not match at their edges.
class TriangleTree {
public:
  explicit TriangleTree(const std::vector<Triangle>& triangles);

  /// Finds the triangles that meet the inside of the cube, and a few that only come close. A slender triangle
  /// may be found several times.
  void find_overlapping(geometry::Vec3 low, double edge, std::vector<std::int32_t>& found) const;
  /// As find_overlapping(), from the triangles of a larger cube around this one.
  void keep_overlapping(geometry::Vec3 low, double edge, std::span<const std::int32_t> candidates,
                        std::vector<std::int32_t>& found) const;
  /// Whether the point is inside: the parity of crossings, by majority of three directions.
  bool contains(geometry::Vec3 point) const;
  /// The fraction of a cube on the inner side of the nearest of these triangles, taken as a plane. This is
  /// right on average over cubes that a smooth surface cuts.
  double fraction_behind(geometry::Vec3 low, double edge, std::span<const std::int32_t> triangles) const;

private:
  /// The distance along the ray to the box; infinite if the ray misses it.
  static double entry(const geometry::Box& box, geometry::Vec3 point, geometry::Vec3 inverse) {
    double enter = 0, leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (box.low[axis] - point[axis]) * inverse[axis],
                   b = (box.high[axis] - point[axis]) * inverse[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave ? enter : std::numeric_limits<double>::infinity();
  }
  bool odd_crossings(geometry::Vec3 point, geometry::Vec3 direction) const;
  bool overlaps_inside(std::int32_t triangle, geometry::Vec3 low, double edge) const;

  std::vector<Triangle> _triangles;  // in the order of the tree
  static constexpr std::int32_t in_one_box = -1;
  std::vector<std::int32_t> _numbers;    // of triangles; equal for the boxes of one triangle
  std::vector<geometry::Box> _boxes;     // of triangles or their parts
  std::vector<geometry::Vec3> _normals;  // their length is twice the area
  geometry::BoxTree _tree;
};

}  // namespace aeroloom::sizing
