#include "surface/front/boundary_triangulation.hpp"

#include "surface/front/edge_crossings.hpp"

#include <algorithm>

namespace aeroloom::front {
namespace {

using Edge = std::array<std::int32_t, 2>;

[[noreturn]] void report(const FrontInput& boundary, const std::string& fallback) {
  auto crossings = find_edge_crossings(boundary);
  if (crossings.empty()) throw FrontError(fallback, {});
  const geometry::Vec2 at = boundary.points[boundary.edges[crossings.front().first][0]];
  const std::string text = "the boundary of a face meets itself in " + std::to_string(crossings.size()) +
                           " pairs of edges, first near chart point (" + std::to_string(at.x) + ", " +
                           std::to_string(at.y) + ")";
  throw FrontError(text, std::move(crossings));
}

void check_edges(const FrontInput& boundary, const std::vector<Edge>& sorted) {
  const bool loop = std::any_of(sorted.begin(), sorted.end(), [](const Edge& e) { return e[0] == e[1]; });
  if (loop) throw FrontError("a boundary edge starts and ends in the same vertex", {});
  if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
    report(boundary, "a boundary edge occurs twice");
}

void recover_edges(const FrontInput& boundary, Delaunay& plane) {
  if (plane.has_duplicates()) report(boundary, "two boundary vertices coincide");
  bool complete = true;
  for (const auto& [a, b] : boundary.edges) complete = plane.recover(a, b) && complete;
  if (!complete) report(boundary, "a boundary vertex that belongs to no edge lies on one");
}

/// Spreads from the left of every edge up to the next edges.
void mark_inside(const FrontInput& boundary, Delaunay& plane) {
  std::vector<std::int32_t> stack;
  const auto visit = [&](std::int32_t t) {
    if (state_of(plane.mesh.triangles[t]) != TriangleState::outside) return;
    set_state(plane.mesh.triangles[t], TriangleState::waiting);
    stack.push_back(t);
  };
  for (const auto& [a, b] : boundary.edges) {
    visit(geometry::triangle_of(plane.mesh.find(a, b)));
    while (!stack.empty()) {
      const std::int32_t t = stack.back();
      stack.pop_back();
      for (int i = 0; i < 3; ++i) {
        const geometry::LinkedEdge edge = geometry::linked_edge(t, i), other = plane.mesh.twin(edge);
        if (other == geometry::no_linked_edge)
          throw FrontError("the boundary is open or runs clockwise around the region", {});
        if (!plane.mesh.is_fixed(edge)) visit(geometry::triangle_of(other));
      }
    }
  }
}

void check_outside(const FrontInput& boundary, const std::vector<Edge>& sorted, const Delaunay& plane) {
  for (const auto& [a, b] : boundary.edges) {
    const auto right = geometry::triangle_of(plane.mesh.find(b, a));
    if (state_of(plane.mesh.triangles[right]) == TriangleState::outside) continue;
    if (!std::binary_search(sorted.begin(), sorted.end(), Edge{b, a}))
      throw FrontError("boundary loops disagree about the side the region is on", {});
  }
}

}  // namespace

Delaunay triangulate_region(const FrontInput& boundary) {
  std::vector<Edge> sorted = boundary.edges;
  std::sort(sorted.begin(), sorted.end());
  check_edges(boundary, sorted);
  Delaunay plane(boundary.points);
  recover_edges(boundary, plane);
  mark_inside(boundary, plane);
  check_outside(boundary, sorted, plane);
  return plane;
}

}  // namespace aeroloom::front
