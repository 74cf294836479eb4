#include "cad/faceted/plane_filling.hpp"

#include "cad/faceted/plane_graph.hpp"

#include <array>
#include <map>
#include <utility>

namespace aeroloom::cad {

using geometry::Vec3;

std::optional<std::vector<geometry::TriangleCorners>> triangles_on_plane(const FacetSoup& soup,
                                                                         std::span<const OpenSide> sides,
                                                                         const FacetPlane& plane) {
  Vec3 normal;
  normal[plane.axis] = plane.positive ? -1 : 1;
  const CoordinatePlane flat(normal);
  PlaneGraph graph;
  graph.filling = PlaneFilling::alternating;
  std::map<std::int32_t, std::int32_t> number;
  std::vector<std::int32_t> points;
  for (const OpenSide& side : sides) {
    std::array<std::int32_t, 2> ends{};
    for (int i = 0; i < 2; ++i) {
      const auto [found, is_new] = number.emplace(side.points[i], static_cast<std::int32_t>(points.size()));
      if (is_new) points.push_back(side.points[i]), graph.places.push_back(flat(soup.points[side.points[i]]));
      ends[i] = found->second;
    }
    graph.sides.push_back(ends);
  }
  auto triangles = fill_plane_graph(graph);
  if (!triangles) return std::nullopt;
  for (geometry::TriangleCorners& corners : *triangles) {
    corners = {points[corners[0]], points[corners[1]], points[corners[2]]};
    const Vec3 area = cross(soup.points[corners[1]] - soup.points[corners[0]],
                            soup.points[corners[2]] - soup.points[corners[0]]);
    if (dot(area, normal) < 0) std::swap(corners[1], corners[2]);
  }
  return triangles;
}

}  // namespace aeroloom::cad
