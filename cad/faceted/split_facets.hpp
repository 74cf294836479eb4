/// Faces, curves and vertices of repaired triangles. Seen by this folder only.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/features.hpp"

#include <vector>

namespace aeroloom::cad {

/// The triangles of a soup are oriented: normals point out of `front`. Names of regions are the caller's.
FacetComplex split_facets(const FacetSoup& soup, const std::vector<FacetSkin>& skins, double feature_angle);

}  // namespace aeroloom::cad
