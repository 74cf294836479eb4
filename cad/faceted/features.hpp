/// Finds feature sides of a faceted surface and divides it into faces along them. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_complex.hpp"
#include "cad/faceted/facet_sides.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::cad {

struct FacetFeatures {
  std::vector<char> is_feature;        ///< per side of the table
  std::vector<std::int32_t> vertices;  ///< numbers of points, ascending
};

/// Feature sides are those with more than two triangles, those between regions or groups, and those at which
/// the surface turns by more than `angle` (radians). Among the last, short open chains that are hardly
/// sharper count as noise. The others are continued over less sharp sides if these lead to another feature.
/// Vertices are points where other than two feature sides meet, or where a chain turns by more than `angle`.
/// Every closed chain has a vertex. Normals of triangles must point out of `front`.
FacetFeatures find_features(const FacetSoup& soup, const std::vector<FacetRegions>& regions,
                            const SideTable& table, double angle);

/// Divides a soup into faces, curves and vertices. Normals of triangles must point out of `front`. The caller
/// names the regions.
FacetComplex split_facets(const FacetSoup& soup, const std::vector<FacetRegions>& regions,
                          double feature_angle);

}  // namespace aeroloom::cad
