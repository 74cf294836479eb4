/// Finds a leading edge and a junction on a surface mesh, for close-up pictures.
#pragma once

#include "pipeline/report/picture/edge_neighbours.hpp"
#include "pipeline/report/picture/scene.hpp"

#include <optional>

namespace aeroloom::picture {

/// A point on a line of the surface, seen from the flow.
struct Place {
  geometry::Vec3 point;
  geometry::Vec3 normal;  ///< unit, towards the flow; at a crease or sharp edge the mean of both sides
  geometry::Vec3 along;   ///< unit, along the line, normal to `normal`
  double size = 0;        ///< mean edge length nearby
  bool upstream = false;  ///< the line faces the flow; else it is the sharpest edge found
};

/// The middle of the longest leading edge; the flow comes along x. A triangle lies on a leading edge under
/// three conditions. (1) The wall normal points upstream by at least 0.3. (2) The flow divides there: the
/// normal of the cross-section points upstream inside the triangle or at its edge. (3) The curvature across
/// the edge exceeds 15 over the diagonal of the shown body; along the edge it is less than 0.4 times that.
/// Connected triangles form one leading edge; of those within 2 % of the longest extent the lowest in y is
/// taken. Without a leading edge: the edge or triangle with the largest turning angle (at least 40 degrees,
/// or a curvature of 8 over the diagonal); else nothing. Curvature tensor: Cohen-Steiner and Morvan (SoCG
/// 2003, doi:10.1145/777792.777839), over one triangle. Collective.
std::optional<Place> find_leading_edge(const mesh::NumberedMesh& surface, const EdgeNeighbours& neighbours,
                                       const Scene& scene);

/// The upstream end of the longest crease: connected edges where the surface turns towards the flow by more
/// than 20 degrees. Empty without a body or a crease of more than 10 edges. All edges of creases are gathered
/// on rank 0; creases are lines, so these are few. Collective.
std::optional<Place> find_junction(const mesh::NumberedMesh& surface, const EdgeNeighbours& neighbours,
                                   const Scene& scene);

}  // namespace aeroloom::picture
