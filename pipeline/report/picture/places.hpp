/// Places of a surface that are worth a look, found from the mesh alone.
#pragma once

#include "pipeline/report/picture/edge_neighbours.hpp"
#include "pipeline/report/picture/scene.hpp"

#include <optional>
#include <tuple>

namespace aeroloom::picture {

/// A place on a line of the surface, seen from the flow.
struct Place {
  geometry::Vec3 point;
  geometry::Vec3
      normal;  ///< unit, towards the flow; in a crease or at a sharp edge half way between both sides
  geometry::Vec3 along;   ///< unit, along the line, perpendicular to the normal
  double size = 0;        ///< mean length of edges there
  bool upstream = false;  ///< of an edge: the flow meets it, else it is only the sharpest there is

  static constexpr auto fields() {
    return std::tuple(&Place::point, &Place::normal, &Place::along, &Place::size, &Place::upstream);
  }
};

/// The middle of the longest leading edge of a body. The flow comes along x from below. A triangle lies on a
/// leading edge where the normal of the wall points upstream, by 0.3 at least; where the flow divides, so
/// that the normal of the cross-section points upstream inside of the triangle or at its edge; and where the
/// wall is curved by more than 15 to the diagonal of what is shown, and less than 0.4 times as much along the
/// edge as across. Triangles that share a vertex belong to one leading edge; of those of the longest extent,
/// to 2 %, the lowest in y. Where there is none, or no body, the edge or curved triangle that turns most, by
/// 40 degrees at an edge or with a curvature of 8 to the diagonal; where there is none either, nothing. The
/// tensor of curvature is that of Cohen-Steiner and Morvan (SoCG 2003, doi:10.1145/777792.777839) over a
/// triangle. Collective.
std::optional<Place> find_leading_edge(const mesh::NumberedMesh& surface, const EdgeNeighbours& neighbours,
                                       const Scene& scene);

/// The upstream end of the crease of the longest extent: edges where what is shown turns towards the flow by
/// more than 20 degrees; those that share a vertex are one crease. Nothing without a body, or where there is
/// no crease longer than 10 edges. Creases are lines, so all their edges travel to rank 0. Collective.
std::optional<Place> find_junction(const mesh::NumberedMesh& surface, const EdgeNeighbours& neighbours,
                                   const Scene& scene);

}  // namespace aeroloom::picture
