/// Triangles in a tree of boxes: what overlaps a cube, and on which side of a closed surface a point lies.
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
  int from = 0;  ///< corner; it leads to the next one
  double length = 0;
};
LongestEdge longest_edge(const Triangle& t);

/// The halves of a triangle, cut in the middle of the edge from that corner to the next one.
std::array<Triangle, 2> bisect(const Triangle& t, int from);

/// A line that does not slip between triangles which share an edge or a corner: each corner is sheared by
/// itself to where the line is the third axis, so those triangles have the same corners there too, and on
/// which side of an edge the line is gets an exact sign. Woop, Benthin and Wald, J. Computer Graphics
/// Techniques 2(1), 2013, https://jcgt.org/published/0002/01/05/.
class ShearedLine {
public:
  /// The direction is a unit vector.
  ShearedLine(geometry::Vec3 point, geometry::Vec3 direction);

  /// How far along the line a triangle is, border included, negative behind the point; infinity where the
  /// line misses it, meets it in the point, or lies in its plane.
  double place_of(const Triangle& t) const;

private:
  geometry::Vec3 sheared(geometry::Vec3 p) const {
    const geometry::Vec3 from = p - _point;
    const double along = from[_axis];
    return {from[_first] - _shear.x * along, from[_second] - _shear.y * along, _scale * along};
  }

  geometry::Vec3 _point;
  int _axis, _first, _second;  // the one that the line runs along most, and the others
  geometry::Vec2 _shear;
  double _scale;
};

/// For estimates: floating point throughout, and the surface may have gaps of facets that do not match.
class TriangleTree {
public:
  explicit TriangleTree(const std::vector<Triangle>& triangles);

  /// The triangles that meet the inside of the cube (a few that only come close included); slender ones as
  /// several that are the same.
  void find_overlapping(geometry::Vec3 low, double edge, std::vector<std::int32_t>& found) const;
  /// As find_overlapping(), given those of a cube around this one.
  void keep_overlapping(geometry::Vec3 low, double edge, std::span<const std::int32_t> candidates,
                        std::vector<std::int32_t>& found) const;
  /// Whether the point lies inside, by the parity of crossings, majority of three directions.
  bool contains(geometry::Vec3 point) const;
  /// The share of a cube that lies on the inner side of that of these triangles which is nearest to its
  /// middle, as if that were a plane: right on average over cubes that a smooth surface cuts.
  double share_behind(geometry::Vec3 low, double edge, std::span<const std::int32_t> triangles) const;

private:
  /// How far along the ray the box begins; infinity where the ray misses it.
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
  std::vector<std::int32_t> _numbers;    // of those with several boxes, the same for each of them
  std::vector<geometry::Box> _boxes;     // of those, or of a part
  std::vector<geometry::Vec3> _normals;  // twice as long as their areas
  geometry::BoxTree _tree;
};

}  // namespace aeroloom::sizing
