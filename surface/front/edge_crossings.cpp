#include "surface/front/edge_crossings.hpp"

#include "geometry/predicates.hpp"

#include <algorithm>

namespace aeroloom::front {
namespace {

using geometry::orient2d;
using geometry::Vec2;

/// Whether p, known to be on the line of ab, lies on the closed segment.
bool is_within(Vec2 a, Vec2 b, Vec2 p) {
  return std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) && std::min(a.y, b.y) <= p.y &&
         p.y <= std::max(a.y, b.y);
}

bool is_on_segment(Vec2 a, Vec2 b, Vec2 p) {
  return is_within(a, b, p) && orient2d(a, b, p) == 0;
}

bool segments_meet(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
  if (orient2d(a, b, c) * orient2d(a, b, d) < 0 && orient2d(c, d, a) * orient2d(c, d, b) < 0) return true;
  return is_on_segment(a, b, c) || is_on_segment(a, b, d) || is_on_segment(c, d, a) || is_on_segment(c, d, b);
}

bool edges_conflict(const FrontInput& boundary, std::int32_t first, std::int32_t second) {
  auto [a, b] = boundary.edges[first];
  auto [c, d] = boundary.edges[second];
  const auto& p = boundary.points;
  if (a == d && b == c) return false;  // both sides of an edge inside the region
  if (a == c && b == d) return true;
  if (b == c || b == d) std::swap(a, b);
  if (a == d) std::swap(c, d);
  if (a == c) return is_on_segment(p[a], p[b], p[d]) || is_on_segment(p[a], p[d], p[b]);
  return segments_meet(p[a], p[b], p[c], p[d]);
}

}  // namespace

std::vector<CrossingEdges> find_edge_crossings(const FrontInput& boundary) {
  struct Extent {
    double left, right, low, high;
    std::int32_t edge;
  };
  std::vector<Extent> extents;
  for (std::int32_t e = 0; e < static_cast<std::int32_t>(boundary.edges.size()); ++e) {
    const Vec2 a = boundary.points[boundary.edges[e][0]], b = boundary.points[boundary.edges[e][1]];
    extents.push_back({std::min(a.x, b.x), std::max(a.x, b.x), std::min(a.y, b.y), std::max(a.y, b.y), e});
  }
  std::sort(extents.begin(), extents.end(), [](const Extent& a, const Extent& b) {
    return a.left != b.left ? a.left < b.left : a.edge < b.edge;
  });
  std::vector<CrossingEdges> found;
  std::vector<Extent> active;  // those the sweep line meets
  for (const Extent& next : extents) {
    std::erase_if(active, [&](const Extent& e) { return e.right < next.left; });
    for (const Extent& e : active) {
      if (e.low <= next.high && next.low <= e.high && edges_conflict(boundary, e.edge, next.edge))
        found.push_back({std::min(e.edge, next.edge), std::max(e.edge, next.edge)});
    }
    active.push_back(next);
  }
  std::sort(found.begin(), found.end(), [](const CrossingEdges& a, const CrossingEdges& b) {
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  return found;
}

}  // namespace aeroloom::front
