/// Counts and sizes of a faceted file before any repair.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/read/cad_facts.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

struct FacetGroupFacts {
  std::string name, part;
  std::int32_t triangles = 0;
  double area = 0;
};

struct FacetFacts : FacetCounts {
  std::string format;
  geometry::Box bounds;
  std::vector<FacetGroupFacts> groups;
};

/// Points with equal coordinates count once.
FacetFacts look_at_facets(const FacetSoup& soup);

}  // namespace aeroloom::cad
