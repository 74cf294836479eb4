/// Unites closed components of a soup that cross or touch. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"

namespace aeroloom::cad {

/// Unites components that meet others, each as the solid body it encloses (geometry/unite_surfaces.hpp).
/// Cavities of such bodies are filled. Triangles keep their groups; those of united components come last.
/// Points with equal coordinates must be one, and no side may be open. Coordinates of the result are rounded,
/// so the caller must check for new contacts.
/// False if no two components meet. Every union is listed. Throws CadError that names two components and a
/// place.
bool unite_components(FacetSoup& soup, Changes& changes);

}  // namespace aeroloom::cad
