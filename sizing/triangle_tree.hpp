/// Triangles in a tree of boxes: what overlaps a cube, and on which side of a closed surface a point lies.
#pragma once

#include "geometry/box_tree.hpp"
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
  /// As find_overlapping(), given those of a cube around this one.
  void keep_overlapping(geometry::Vec3 low, double edge, std::span<const std::int32_t> candidates,
                        std::vector<std::int32_t>& found) const;
  /// Whether the point lies inside, by the parity of crossings, majority of three directions.
  bool contains(geometry::Vec3 point) const;
  /// The share of a cube that lies on the inner side of that of these triangles which is nearest to its
  /// middle, as if that were a plane: right on average over cubes that a smooth surface cuts.
  double share_behind(geometry::Vec3 low, double edge, std::span<const std::int32_t> triangles) const;
  /// Calls visit(triangle, distance) for the triangles that a ray crosses within `reach`, in no particular
  /// order. The direction is a unit vector.
  template <class Visit>
  void for_each_crossing(geometry::Vec3 point, geometry::Vec3 direction, double reach, Visit&& visit) const {
    std::vector<Crossing> crossings;
    find_crossings(point, direction, reach, crossings);
    for (const Crossing& crossing : crossings) visit(_tree.order()[crossing.triangle], crossing.distance);
  }

private:
  struct Crossing {
    std::int32_t triangle;
    double distance;
  };
  void find_crossings(geometry::Vec3 point, geometry::Vec3 direction, double reach,
                      std::vector<Crossing>& found) const;
  bool odd_crossings(geometry::Vec3 point, geometry::Vec3 direction) const;
  bool overlaps_inside(std::int32_t triangle, geometry::Vec3 low, double edge) const;

  std::vector<Triangle> _triangles;   // in the order of the tree
  std::vector<geometry::Box> _boxes;  // of those
  geometry::BoxTree _tree;
};

}  // namespace aeroloom::sizing
