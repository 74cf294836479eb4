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
  /// A triangle that a ray crosses, -1 none, and how far away.
  struct Crossing {
    std::int32_t triangle = -1;
    double distance = 0;
  };
  /// The nearest of the triangles that a line crosses within `reach` of a point, ahead of it and behind it,
  /// and that `counts(triangle)`; the lower one where two are as near. The direction is a unit vector.
  template <class Counts>
  std::array<Crossing, 2> nearest_crossings(geometry::Vec3 point, geometry::Vec3 direction, double reach,
                                            const Counts& counts) const {
    const geometry::Vec3 from = point - reach * direction, to = point + reach * direction;
    const geometry::Vec3 inverse{1 / direction.x, 1 / direction.y, 1 / direction.z};
    geometry::Box around;
    around.add(from), around.add(to);
    std::array<Crossing, 2> nearest{Crossing{-1, reach}, Crossing{-1, reach}};
    _tree.search(
        [&](const geometry::Box& box) {
          return box.overlaps(around) && entry(box, from, inverse) <= 2 * reach;
        },
        [&](std::int32_t place) {
          const std::int32_t triangle = _tree.order()[place];
          if (!_boxes[place].overlaps(around) || !counts(triangle)) return;
          const double along = crossing(place, point, direction), away = std::abs(along);
          Crossing& best = nearest[along > 0 ? 0 : 1];
          if (away < best.distance ||
              (away == best.distance && (best.triangle < 0 || triangle < best.triangle)))
            best = {triangle, away};
        });
    return nearest;
  }

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
  /// How far along the line the triangle at a place of the tree is, negative behind the point; infinity where
  /// the line misses it or meets it in the point.
  double crossing(std::int32_t place, geometry::Vec3 point, geometry::Vec3 direction) const;
  bool odd_crossings(geometry::Vec3 point, geometry::Vec3 direction) const;
  bool overlaps_inside(std::int32_t triangle, geometry::Vec3 low, double edge) const;

  std::vector<Triangle> _triangles;      // in the order of the tree
  std::vector<geometry::Box> _boxes;     // of those
  std::vector<geometry::Vec3> _normals;  // twice as long as their areas
  geometry::BoxTree _tree;
};

}  // namespace aeroloom::sizing
