/// Repairs the triangles of a file and finds regions, faces, curves and vertices.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"

#include <cstdint>

namespace aeroloom::cad {

/// Whether closed components that cross or touch are refused or united.
enum class CrossingFacets : std::uint8_t { refuse, unite };

/// Repairs what has only one possible repair, finds the enclosed regions, and divides the triangles into
/// faces. Faces end where the surface turns by more than `feature_angle` (radians), at borders of groups, and
/// where more than two triangles meet. Every change is listed. Throws CadError if the triangles are not
/// closed, enclose nothing, or intersect and are not united.
FacetComplex make_facet_complex(FacetSoup soup, double feature_angle, Changes& changes,
                                CrossingFacets crossing = CrossingFacets::refuse);

}  // namespace aeroloom::cad
