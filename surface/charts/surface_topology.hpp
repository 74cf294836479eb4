/// Connectivity of a chart surface: its half-edges (geometry/half_edges.hpp), boundary loops, parts.
#pragma once

#include "geometry/half_edges.hpp"
#include "surface/charts/chart_surface.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::surface {

inline std::int32_t start_of(const ChartSurface& surface, geometry::HalfEdge h) {
  return surface.triangles[h / 3][h % 3];
}
inline std::int32_t end_of(const ChartSurface& surface, geometry::HalfEdge h) {
  return start_of(surface, geometry::next_half_edge(h));
}
inline geometry::Vec2 start_uv(const ChartSurface& surface, geometry::HalfEdge h) {
  return surface.corner_uv[h / 3][h % 3];
}
inline geometry::Vec2 end_uv(const ChartSurface& surface, geometry::HalfEdge h) {
  return start_uv(surface, geometry::next_half_edge(h));
}

/// The boundary as closed loops of half-edges, the chart surface on the left; by ascending first half-edge.
/// Every point must have at most one outgoing boundary half-edge, as separate_parts() leaves it.
std::vector<std::vector<geometry::HalfEdge>> trace_boundary(const ChartSurface& surface,
                                                            const std::vector<geometry::HalfEdge>& twins);

/// The chords between consecutive mesh vertices along the boundary loops; a loop without any gives none.
std::vector<std::array<std::int32_t, 2>> trace_loop_edges(const ChartSurface& surface);

/// Takes the triangles apart by their part number; -1 drops a triangle. A point occurs in each part once per
/// fan of triangles around it, so that the boundary of a part never touches itself. loop_edges are set.
std::vector<ChartSurface> separate_parts(const ChartSurface& surface,
                                         const std::vector<geometry::HalfEdge>& twins,
                                         const std::vector<std::int32_t>& part, std::int32_t parts);

/// Numbers the edge-connected components of equal label, in order of their first triangles. Returns their
/// count.
std::int32_t label_components(const std::vector<geometry::HalfEdge>& twins,
                              const std::vector<std::int32_t>& label, std::vector<std::int32_t>& component);

/// Whether a connected chart surface is a disk, or a disk with holes: what a plane can hold.
bool is_planar_domain(const ChartSurface& surface);

/// A new point on a half-edge. Points inside the chart surface are listed for both half-edges of their edge.
struct EdgePoint {
  geometry::HalfEdge half_edge;
  double fraction;     ///< from the start of this half-edge, in (0,1)
  std::int32_t point;  ///< index into Chart surface::points, present already
  geometry::Vec2 uv;   ///< as seen from this side
};

/// Divides triangles so that they have the given points as corners. Returns the former triangle of each.
/// loop_edges are not touched.
std::vector<std::int32_t> divide_edges(ChartSurface& surface, std::vector<EdgePoint> points);

geometry::Vec3 area_vector(const ChartSurface& surface, std::int32_t triangle);  ///< normal times area
double surface_area(const ChartSurface& surface);

}  // namespace aeroloom::surface
