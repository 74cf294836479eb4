/// Connectivity of a support: its half-edges (geometry/half_edges.hpp), boundary loops, parts.
#pragma once

#include "geometry/half_edges.hpp"
#include "surface/charts/support.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::surface {

inline std::int32_t start_of(const Support& support, geometry::HalfEdge h) {
  return support.triangles[h / 3][h % 3];
}
inline std::int32_t end_of(const Support& support, geometry::HalfEdge h) {
  return start_of(support, geometry::next_half_edge(h));
}
inline geometry::Vec2 start_uv(const Support& support, geometry::HalfEdge h) {
  return support.corner_uv[h / 3][h % 3];
}
inline geometry::Vec2 end_uv(const Support& support, geometry::HalfEdge h) {
  return start_uv(support, geometry::next_half_edge(h));
}

/// The boundary as closed loops of half-edges, the support on the left; by ascending first half-edge. Every
/// point must have at most one outgoing boundary half-edge, as separate_parts() leaves it.
std::vector<std::vector<geometry::HalfEdge>> trace_boundary(const Support& support,
                                                            const std::vector<geometry::HalfEdge>& twins);

/// The chords between consecutive mesh vertices along the boundary loops; a loop without any gives none.
std::vector<std::array<std::int32_t, 2>> trace_loop_edges(const Support& support);

/// Takes the triangles apart by their part number; -1 drops a triangle. A point occurs in each part once per
/// fan of triangles around it, so that the boundary of a part never touches itself. loop_edges are set.
std::vector<Support> separate_parts(const Support& support, const std::vector<geometry::HalfEdge>& twins,
                                    const std::vector<std::int32_t>& part, std::int32_t parts);

/// Numbers the edge-connected components of equal label, in order of their first triangles. Returns their
/// count.
std::int32_t label_components(const std::vector<geometry::HalfEdge>& twins,
                              const std::vector<std::int32_t>& label, std::vector<std::int32_t>& component);

/// Whether a connected support is a disk, or a disk with holes: what a plane can hold.
bool is_planar_domain(const Support& support);

/// A new point on a half-edge. Points inside the support are listed for both half-edges of their edge.
struct EdgePoint {
  geometry::HalfEdge half_edge;
  double fraction;     ///< from the start of this half-edge, in (0,1)
  std::int32_t point;  ///< index into Support::points, present already
  geometry::Vec2 uv;   ///< as seen from this side
};

/// Divides triangles so that they have the given points as corners. Returns the former triangle of each.
/// loop_edges are not touched.
std::vector<std::int32_t> divide_edges(Support& support, std::vector<EdgePoint> points);

geometry::Vec3 area_vector(const Support& support, std::int32_t triangle);  ///< normal times area
double support_area(const Support& support);

}  // namespace aeroloom::surface
