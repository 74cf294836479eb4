#include "surface/front/plane_smoothing.hpp"

#include "surface/front/boundary_triangulation.hpp"

#include <numbers>

namespace aeroloom::front {
namespace {

using geometry::Vec2;

/// An edge of the ring around a vertex, the vertex on its left.
struct RingEdge {
  Vec2 from, to;
};

void gather_ring(const Delaunay& plane, std::int32_t vertex, std::vector<RingEdge>& ring) {
  ring.clear();
  const std::int32_t start = plane.mesh.triangle_at[vertex];
  std::int32_t t = start;
  do {
    const auto& triangle = plane.mesh.triangles[t];
    const int k = plane.mesh.corner(t, vertex);
    ring.push_back({plane.points[triangle.vertices[geometry::next_corner(k)]],
                    plane.points[triangle.vertices[geometry::previous_corner(k)]]});
    t = geometry::triangle_of(triangle.links[geometry::next_corner(k)]);
  } while (t != start);
}

/// Mean over the ring of the apexes of equilateral triangles on its edges.
Vec2 ideal_place(const std::vector<RingEdge>& ring) {
  constexpr double height = std::numbers::sqrt3 / 2;
  Vec2 sum;
  for (const RingEdge& edge : ring) {
    const Vec2 along = edge.to - edge.from;
    sum += 0.5 * (edge.from + edge.to) + height * Vec2{-along.y, along.x};
  }
  return sum / static_cast<double>(ring.size());
}

/// Sum of inverse mean ratios over the ring, infinite where a triangle is folded: lower is better, and the
/// worst counts most.
double ring_energy(const std::vector<RingEdge>& ring, Vec2 centre) {
  double energy = 0;
  for (const RingEdge& edge : ring) {
    const Vec2 u = edge.from - centre, v = edge.to - centre, w = edge.to - edge.from;
    const double area2 = cross(u, v), squares = dot(u, u) + dot(v, v) + dot(w, w);
    constexpr double no_area = 1e-14;  // what rounding of coordinates makes of a triangle without one
    if (!(area2 > no_area * squares)) return std::numeric_limits<double>::infinity();
    energy += squares / (2 * std::numbers::sqrt3 * area2);
  }
  return energy;
}

void restore_delaunay(Delaunay& plane) {
  std::vector<geometry::LinkedEdge> stack;
  for (std::int32_t t = 0; t < static_cast<std::int32_t>(plane.mesh.triangles.size()); ++t) {
    if (state_of(plane.mesh.triangles[t]) == TriangleState::outside) continue;
    for (int i = 0; i < 3; ++i) {
      if (plane.mesh.triangles[t].links[i] < geometry::linked_edge(t, i)) continue;  // seen once is enough
      stack.push_back(geometry::linked_edge(t, i));
      plane.restore(stack);
    }
  }
}

}  // namespace

void smooth_plane(Delaunay& plane, std::int32_t first_free, int sweeps) {
  std::vector<RingEdge> ring;
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    for (auto v = first_free; v < static_cast<std::int32_t>(plane.points.size()); ++v) {
      gather_ring(plane, v, ring);
      const Vec2 place = ideal_place(ring);
      if (ring_energy(ring, place) < ring_energy(ring, plane.points[v])) plane.points[v] = place;
    }
    restore_delaunay(plane);
  }
}

}  // namespace aeroloom::front
