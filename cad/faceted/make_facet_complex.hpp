/// Repairs the triangles of a file and finds regions, faces, curves and vertices.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/opening_rules.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// What becomes of solids that touch or cross. `join`: those that touch share their faces and are regions;
/// those that cross are refused. `unite`: they become one; those that only touch, and cannot be united, are
/// joined.
enum class CrossingFacets : std::uint8_t { join, unite };

/// Repairs what has only one possible repair, finds the enclosed regions, and divides the triangles into
/// faces. Faces end where the surface turns by more than `feature_angle` (radians), at borders of groups, and
/// where more than two triangles meet. Solids whose name matches a pattern in `voids` are voids. Every change
/// is listed. `openings`: rules for what is open; null: none. Throws CadError if the triangles are not
/// closed, enclose nothing, or intersect and are neither joined nor united.
FacetComplex make_facet_complex(FacetSoup soup, double feature_angle, Changes& changes,
                                CrossingFacets crossing = CrossingFacets::join,
                                const std::vector<std::string>& voids = {}, OpeningRules* openings = nullptr);

}  // namespace aeroloom::cad
