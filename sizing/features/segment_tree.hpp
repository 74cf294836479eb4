/// Segments in a tree of boxes, to find the one nearest to a point.
#pragma once

#include "geometry/box_tree.hpp"
#include "geometry/vec.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace aeroloom::sizing {

/// The place on the segment from a to b that is nearest to p, from 0 at a to 1 at b.
inline double part_along(geometry::Vec3 p, geometry::Vec3 a, geometry::Vec3 b) {
  const geometry::Vec3 along = b - a;
  const double square = dot(along, along);
  return square > 0 ? std::clamp(dot(p - a, along) / square, 0.0, 1.0) : 0;
}

inline double distance_to_segment(geometry::Vec3 p, geometry::Vec3 a, geometry::Vec3 b) {
  return distance(p, a + part_along(p, a, b) * (b - a));
}

/// Zero inside the box.
inline double distance_to_box(geometry::Vec3 p, const geometry::Box& box) {
  geometry::Vec3 apart;
  for (int axis = 0; axis < 3; ++axis)
    apart[axis] = std::max({box.low[axis] - p[axis], p[axis] - box.high[axis], 0.0});
  return norm(apart);
}

class SegmentTree {
public:
  struct Segment {
    geometry::Vec3 a, b;
    std::int32_t tag;  ///< number of what the segment belongs to
  };

  SegmentTree() = default;
  explicit SegmentTree(std::vector<Segment> segments) : _segments(std::move(segments)) {
    std::vector<geometry::Box> boxes(_segments.size());
    for (std::size_t i = 0; i < _segments.size(); ++i)
      boxes[i].add(_segments[i].a), boxes[i].add(_segments[i].b);
    _tree = geometry::BoxTree(boxes, segments_per_leaf);
  }

  struct Hit {
    double away;
    std::int32_t tag = -1;  ///< -1: no segment is that near
  };
  /// The nearest segment for whose tag `counts(tag)` is true. Where none is nearer than `bound`, returns
  /// `bound` and tag -1. Tags are tried in no particular order, and not all of them. Adds the number of
  /// visited nodes to `nodes`, if given.
  template <class Counts>
  Hit nearest_hit(geometry::Vec3 p, double bound, const Counts& counts, std::int64_t* nodes = nullptr) const {
    std::int32_t tag = -1;
    const auto away_from = [&](const geometry::Box& box) {
      if (nodes != nullptr) ++*nodes;
      return distance_to_box(p, box);
    };
    _tree.search_nearest(away_from, bound, [&](std::int32_t place) {
      const Segment& segment = _segments[_tree.order()[place]];
      const double away = distance_to_segment(p, segment.a, segment.b);
      if (away < bound && counts(segment.tag)) bound = away, tag = segment.tag;
    });
    return {bound, tag};
  }
  /// The distance to the nearest of all segments, or `bound`.
  double nearest(geometry::Vec3 p, double bound, std::int64_t* nodes = nullptr) const {
    return nearest_hit(
               p, bound, [](std::int32_t) { return true; }, nodes)
        .away;
  }

private:
  static constexpr int segments_per_leaf = 4;  // chosen, not measured

  std::vector<Segment> _segments;
  geometry::BoxTree _tree;
};

}  // namespace aeroloom::sizing
