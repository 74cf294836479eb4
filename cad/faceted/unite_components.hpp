/// Closed components of a soup that cross or touch others, united. Seen by this folder only.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"

namespace aeroloom::cad {

/// Unites components that meet others (geometry/unite_surfaces.hpp), each as the body that it encloses;
/// cavities of bodies that meet others are filled. Triangles keep their groups; those of united components
/// come last. Points with equal coordinates must be one, no side open. The result is rounded: what crosses
/// then is for the caller to find. False where nothing meets, or a component meets itself. Lists every union.
/// Throws CadError naming two components and a place.
bool unite_components(FacetSoup& soup, Changes& changes);

}  // namespace aeroloom::cad
