/// Closes halves of bodies of triangles at their plane of symmetry. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_plane.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/opening_rules.hpp"

namespace aeroloom::cad {

/// Makes a soup of closed halves, where they meet the plane. Borders are joined first (close_facets.hpp).
/// Points of open sides and of flat sides within reach are put on the plane, and points up to the reach
/// beyond it. What lies farther beyond is cut off. Chains of open sides that leave the plane are closed
/// (fill_chains). Then the loops on the plane are closed by triangles on it, every second space from outside
/// inward; these replace all triangles on the plane. Openings elsewhere stay. Throws CadError.
FacetPlane close_half_facets(FacetSoup& soup, const FarFieldOptions& options, OpeningRules& openings,
                             Changes& changes);

/// Closes chains of open sides that lead from the plane back to it: by triangles between their own points if
/// these are narrow or planar, else down to the plane if they come no farther than `tolerances::widest_ruled`
/// of the diagonal; the one with less area first. Those that `openings` name
/// may be wide. Throws CadError for others that are, with length, width and place, and for all if the rules
/// refuse.
void fill_chains(FacetSoup& soup, const FacetPlane& plane, OpeningRules& openings, Changes& changes);

}  // namespace aeroloom::cad
