/// The walls of faceted bodies that a surrounding fluid touches. Internal to cad/.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "cad/repair/change.hpp"

namespace aeroloom::cad {

/// The outer faces of the bodies, seen from the fluid, which is region 0. Faces between bodies and in
/// cavities are left out, and so are bodies inside others. Changes are listed. Regions lose their names.
FacetComplex outer_walls(const FacetComplex& bodies, Changes& changes);

/// The volume inside a closed surface whose normals point outward.
double enclosed_volume(const FacetComplex& complex);

}  // namespace aeroloom::cad
