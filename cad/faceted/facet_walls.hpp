/// The walls of bodies of facets that a fluid around them meets. Seen by this folder only.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "cad/repair/change.hpp"

namespace aeroloom::cad {

/// The outer faces of the bodies, seen from a fluid around them, which is region 0: what lies between bodies,
/// in their cavities, or in a cavity of another is left out and listed. Regions are no longer named.
FacetComplex outer_walls(const FacetComplex& bodies, Changes& changes);

/// What the triangles of a closed surface enclose; their normals point out of it.
double enclosed_volume(const FacetComplex& complex);

}  // namespace aeroloom::cad
