/// Triangles of a faceted model that cross, touch or overlap others than in common points and sides.
#pragma once

#include "cad/faceted/facet_soup.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace aeroloom::cad {

struct FacetContacts {
  std::size_t pairs = 0;
  std::int32_t first = -1, second = -1;  ///< the first pair, ascending; -1 without
};

/// Exact. Points with equal coordinates must be one.
FacetContacts find_facet_contacts(const FacetSoup& soup);

/// For each triangle what hangs together with it over common points, counted in the order of the file.
struct FacetComponents {
  std::vector<std::int32_t> of;
  std::int32_t count = 0;
};
FacetComponents find_components(const FacetSoup& soup);

}  // namespace aeroloom::cad
