/// A tree of boxes over triangles: what overlaps a cube, and on which side of a closed surface a point lies.
#pragma once

#include "geometry/vec.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::sizing {

using Triangle = std::array<geometry::Vec3, 3>;

/// For estimates: floating point throughout, and the surface may have gaps of facets that do not match.
class TriangleTree {
public:
  explicit TriangleTree(std::vector<Triangle> triangles);

  /// The triangles that meet the inside of the cube (a few that only come close included).
  void find_overlapping(geometry::Vec3 low, double edge, std::vector<std::int32_t>& found) const;
  /// Whether the point lies inside, by the parity of crossings, majority of three directions.
  bool contains(geometry::Vec3 point) const;
  /// Whether the point lies on the inner side of the nearest of these triangles.
  bool is_behind(geometry::Vec3 point, std::span<const std::int32_t> triangles) const;

private:
  struct Node {
    geometry::Box box;
    std::int32_t first, count;  ///< triangles of a leaf; count 0: children at first and first + 1
  };
  void split(std::int32_t node, std::int32_t first, std::int32_t last);
  bool odd_crossings(geometry::Vec3 point, geometry::Vec3 direction) const;

  std::vector<Triangle> _triangles;
  std::vector<Node> _nodes;
};

}  // namespace aeroloom::sizing
