/// Triangles that intersect elsewhere than in common points and sides, and connected components of a soup.
#pragma once

#include "cad/faceted/facet_soup.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// Per triangle the component it belongs to. Components are connected over sides and numbered in the order of
/// the file.
struct FacetComponents {
  std::vector<std::int32_t> of;
  std::int32_t count = 0;
};
FacetComponents find_components(const FacetSoup& soup);

/// Two triangles, the lower number first.
struct FacetContact {
  std::int32_t first, second;
  friend auto operator<=>(const FacetContact&, const FacetContact&) = default;
};

/// All pairs, ascending. Exact. Points with equal coordinates must be one.
std::vector<FacetContact> list_facet_contacts(const FacetSoup& soup);

/// The name of a triangle's component, for messages.
std::string component_name(const FacetSoup& soup, const FacetComponents& components, std::int32_t triangle);

}  // namespace aeroloom::cad
