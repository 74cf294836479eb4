/// Triangles of a faceted model that cross, touch or overlap others than in common points and sides.
#pragma once

#include "cad/faceted/facet_soup.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// For each triangle what hangs together with it over sides, counted in the order of the file.
struct FacetComponents {
  std::vector<std::int32_t> of;
  std::int32_t count = 0;
};
FacetComponents find_components(const FacetSoup& soup);

struct FacetContacts {
  std::size_t pairs = 0;
  /// The first pair, ascending, of two components where there is one; -1 without.
  std::int32_t first = -1, second = -1;
};

/// Two triangles, the lower number first.
struct FacetContact {
  std::int32_t first, second;
  friend auto operator<=>(const FacetContact&, const FacetContact&) = default;
};

/// All pairs, ascending. Exact. Points with equal coordinates must be one.
std::vector<FacetContact> list_facet_contacts(const FacetSoup& soup);

/// What a component is called in messages, by one of its triangles.
std::string component_name(const FacetSoup& soup, const FacetComponents& components, std::int32_t triangle);

/// As list_facet_contacts.
FacetContacts find_facet_contacts(const FacetSoup& soup, const FacetComponents& components);

}  // namespace aeroloom::cad
