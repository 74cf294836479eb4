/// Faces of the file that the case leaves out. Internal to cad/.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/model/named_shape.hpp"
#include "cad/repair/change.hpp"

#include <string>
#include <vector>

namespace aeroloom::cad {

/// Marks faces whose name (shown_name) matches a pattern, or whose number is one of the texts. Throws
/// CadError for a text that means no face.
void ignore_faces(NamedShape& named, const std::vector<std::string>& texts, Changes& changes);

/// Removes triangles of groups whose name or part matches a pattern. Throws CadError for a pattern without a
/// match, and if nothing is left.
void ignore_groups(FacetSoup& soup, const std::vector<std::string>& patterns, Changes& changes);

}  // namespace aeroloom::cad
