/// The sides along which a faceted surface is cut into faces, and the points where curves of them end.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_sides.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::cad {

struct FacetFeatures {
  std::vector<char> is_feature;        ///< per side of the table
  std::vector<std::int32_t> vertices;  ///< points, ascending
};

/// Features are sides where more than two triangles, different regions or different groups meet, and sides at
/// which the surface turns by more than `angle` (radians). Of the latter, open chains that are short and
/// hardly sharper count as noise; those that stay go on over blunter sides where these lead to another
/// feature. Vertices are where other than two features meet and where a chain turns by more than `angle`;
/// every closed chain has one. Triangles are oriented: normals point out of `front`.
FacetFeatures find_features(const FacetSoup& soup, const std::vector<FacetSkin>& skins,
                            const SideTable& table, double angle);

/// The triangles of a soup are oriented: normals point out of `front`. Names of regions are the caller's.
FacetComplex split_facets(const FacetSoup& soup, const std::vector<FacetSkin>& skins, double feature_angle);

}  // namespace aeroloom::cad
