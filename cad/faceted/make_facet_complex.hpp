/// From the triangles of a file to regions, faces, curves and vertices.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"

#include <cstdint>

namespace aeroloom::cad {

/// Whether closed components that cross or touch are refused, or united as bodies.
enum class CrossingFacets : std::uint8_t { refuse, unite };

/// Welds and repairs what can be repaired in one way only, finds the regions that the triangles enclose, and
/// cuts the triangles into faces along sides at which they turn by more than `feature_angle` (radians), along
/// borders of groups and where more than two triangles meet. Every change is listed. Throws CadError where
/// the triangles do not close, cross or overlap (but for components that are united), or enclose nothing.
FacetComplex make_facet_complex(FacetSoup soup, double feature_angle, Changes& changes,
                                CrossingFacets crossing = CrossingFacets::refuse);

}  // namespace aeroloom::cad
