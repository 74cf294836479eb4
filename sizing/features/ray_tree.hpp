/// Triangles in trees for rays: the first triangle that a line meets.
#pragma once

#include "geometry/box_tree.hpp"
#include "sizing/features/triangle_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace aeroloom::sizing {

/// Trees of triangles, for estimates in floating point. The box of a slender triangle at an angle to the axes
/// is mostly empty, so rays meet the box and miss the triangle. Therefore slender triangles of about one
/// direction, and triangles flat across it, have a tree of their own, in a frame along that direction. Each
/// of the remaining slender triangles is in several boxes.
class RayTree {
public:
  explicit RayTree(std::span<const Triangle> triangles);

  /// A triangle that a line crosses, and its distance. The number is -1 if there is none.
  struct Crossing {
    std::int32_t triangle = -1;
    double distance = 0;
  };
  /// The nearest crossings of a line, ahead of the point and behind it, within `reach`. Only triangles for
  /// which `counts(triangle)` is true are met; of two at the same distance, the lower one. `direction`: a
  /// unit vector. `corners(triangle)`: the corners with which the trees were made. No line passes between
  /// triangles that share an edge. Adds the number of visited nodes to `nodes`.
  template <class Counts, class Corners>
  std::array<Crossing, 2> nearest_crossings(geometry::Vec3 point, geometry::Vec3 direction, double reach,
                                            const Corners& corners, const Counts& counts,
                                            std::int64_t& nodes) const;
  /// Finds the triangles that may be as near as `within` to this one, and some others; ascending. A triangle
  /// of the trees finds itself too. Only triangles for which `counts(triangle)` is true are found; it may be
  /// called more than once for one. Adds the number of visited nodes to `nodes`.
  void find_near(const Triangle& triangle, double within, const std::function<bool(std::int32_t)>& counts,
                 std::vector<std::int32_t>& found, std::int64_t& nodes) const;

private:
  using Frame = std::array<geometry::Vec3, 3>;
  static geometry::Vec3 into(const Frame& frame, geometry::Vec3 p) {
    return {dot(frame[0], p), dot(frame[1], p), dot(frame[2], p)};
  }
  struct Group {
    Frame frame;
    double emptiness;                     // of its boxes
    std::vector<std::int32_t> triangles;  // of each box
    geometry::BoxTree tree;
  };
  void add_group(std::span<const Triangle> all, std::span<const std::int32_t> members, const Frame& frame);

  /// A line in the frame of a group, from -reach to reach.
  struct Line {
    geometry::Vec3 point, inverse;
    double reach;
  };
  /// The part of a line that lies in a box, from `low` to `high`.
  struct LineInterval {
    double low, high;
    /// Whether a triangle there may be as near as the nearest found so far, on either side.
    bool matters(const std::array<Crossing, 2>& nearest, double slack) const {
      return low <= high && ((high >= -slack && low <= nearest[0].distance + slack) ||
                             (low <= slack && high >= -nearest[1].distance - slack));
    }
    double away() const { return std::max({low, -high, 0.0}); }
  };
  static LineInterval stretch_in(const geometry::Box& box, const Line& line) {
    LineInterval stretch{-line.reach, line.reach};
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (box.low[axis] - line.point[axis]) * line.inverse[axis],
                   b = (box.high[axis] - line.point[axis]) * line.inverse[axis];
      stretch.low = std::max(stretch.low, std::min(a, b));
      stretch.high = std::min(stretch.high, std::max(a, b));
    }
    return stretch;
  }
  /// Calls `meet(triangle)` for the triangles in boxes that the line meets, nearer boxes first. Boxes farther
  /// than the nearest triangle so far are left out.
  template <class Meet>
  static void search(const Group& group, const Line& line, const std::array<Crossing, 2>& nearest,
                     std::int64_t& nodes, const Meet& meet);

  std::vector<Group> _groups;
};

template <class Meet>
void RayTree::search(const Group& group, const Line& line, const std::array<Crossing, 2>& nearest,
                     std::int64_t& nodes, const Meet& meet) {
  struct Waiting {
    std::int32_t node;
    LineInterval stretch;
  };
  const std::span<const geometry::BoxTree::Node> all = group.tree.nodes();
  const double slack = 1e-9 * line.reach;
  std::array<Waiting, geometry::BoxTree::most_levels> stack;
  int depth = 0;
  const auto reached = [&](std::int32_t node) {
    ++nodes;
    return Waiting{node, stretch_in(all[node].box, line)};
  };
  if (!all.empty()) stack[depth++] = reached(0);
  while (depth > 0) {
    const Waiting next = stack[--depth];
    if (!next.stretch.matters(nearest, slack)) continue;
    const geometry::BoxTree::Node& node = all[next.node];
    if (node.is_leaf()) {
      for (std::int32_t place = node.begin; place < node.end; ++place)
        meet(group.triangles[group.tree.order()[place]]);
      continue;
    }
    // The nearer one is looked into first: most of the other need not be.
    const Waiting left = reached(next.node + 1), right = reached(node.right);
    const bool left_first = left.stretch.away() <= right.stretch.away();
    stack[depth++] = left_first ? right : left;
    stack[depth++] = left_first ? left : right;
  }
}

template <class Counts, class Corners>
std::array<RayTree::Crossing, 2> RayTree::nearest_crossings(geometry::Vec3 point, geometry::Vec3 direction,
                                                            double reach, const Corners& corners,
                                                            const Counts& counts, std::int64_t& nodes) const {
  std::array<Crossing, 2> nearest{Crossing{-1, reach}, Crossing{-1, reach}};
  const ShearedLine sheared(point, direction);
  const auto meet = [&](std::int32_t triangle) {
    if (!counts(triangle)) return;
    const double along = sheared.place_of(corners(triangle)), away = std::abs(along);
    Crossing& best = nearest[along > 0 ? 0 : 1];
    if (away < best.distance || (away == best.distance && (best.triangle < 0 || triangle < best.triangle)))
      best = {triangle, away};
  };
  for (const Group& group : _groups) {
    const geometry::Vec3 along = into(group.frame, direction);
    const Line line{into(group.frame, point), {1 / along.x, 1 / along.y, 1 / along.z}, reach};
    search(group, line, nearest, nodes, meet);
  }
  return nearest;
}

}  // namespace aeroloom::sizing
