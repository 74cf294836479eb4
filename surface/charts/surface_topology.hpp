/// Connectivity of a parametric triangulation: half-edges (geometry/half_edges.hpp), boundary loops,
/// components.
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

/// The boundary as closed loops of half-edges, the surface on the left, by ascending first half-edge. Every
/// point must have at most one outgoing boundary half-edge, as separate_parts() ensures.
std::vector<std::vector<geometry::HalfEdge>> trace_boundary(const ChartSurface& surface,
                                                            const std::vector<geometry::HalfEdge>& twins);

/// The chords between consecutive mesh vertices along the boundary. A loop without mesh vertices gives none.
std::vector<std::array<std::int32_t, 2>> trace_loop_edges(const ChartSurface& surface);

/// Separates the triangles by part number; -1 drops a triangle. A point is copied for each fan of triangles
/// that a part has around it, so that the boundary of a part never touches itself. Sets loop_edges.
std::vector<ChartSurface> separate_parts(const ChartSurface& surface,
                                         const std::vector<geometry::HalfEdge>& twins,
                                         const std::vector<std::int32_t>& part, std::int32_t parts);

/// Numbers the edge-connected components of equal label, in order of their first triangles. Returns their
/// number.
std::int32_t label_components(const std::vector<geometry::HalfEdge>& twins,
                              const std::vector<std::int32_t>& label, std::vector<std::int32_t>& component);

/// The edges that the border uses from both sides, as where two solids touch along a seam: pairs of mesh
/// vertices, the lower one first, ascending.
std::vector<std::array<std::int32_t, 2>> slits_of(const ChartSurface& surface);

/// Whether a connected surface is a disk or a disk with holes, as a chart must be.
bool is_planar_domain(const ChartSurface& surface);

/// A new point on a half-edge. A point inside the surface is listed for both half-edges of its edge.
struct EdgePoint {
  geometry::HalfEdge half_edge;
  double fraction;     ///< from the start of this half-edge, in (0,1)
  std::int32_t point;  ///< index into ChartSurface::points; exists already
  geometry::Vec2 uv;   ///< as seen from this side
};

/// Divides triangles so that the given points become corners. Returns the former triangle of each new one.
/// loop_edges are not changed.
std::vector<std::int32_t> divide_edges(ChartSurface& surface, std::vector<EdgePoint> points);

geometry::Vec3 area_vector(const ChartSurface& surface, std::int32_t triangle);  ///< normal times area
double surface_area(const ChartSurface& surface);

}  // namespace aeroloom::surface
