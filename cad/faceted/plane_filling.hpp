/// Triangles on the plane of symmetry. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_plane.hpp"
#include "cad/faceted/fill_openings.hpp"
#include "geometry/half_edges.hpp"

#include <optional>
#include <span>
#include <vector>

namespace aeroloom::cad {

/// Fills what open sides on the plane enclose, by turns inside and outside of each other. The triangles, by
/// points of the soup, look at the side without fluid. Nothing where the sides cross or touch.
std::optional<std::vector<geometry::TriangleCorners>> triangles_on_plane(const FacetSoup& soup,
                                                                         std::span<const OpenSide> sides,
                                                                         const FacetPlane& plane);

}  // namespace aeroloom::cad
