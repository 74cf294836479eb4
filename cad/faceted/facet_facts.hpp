/// Figures of a faceted file as it stands there, for a look.
#pragma once

#include "cad/faceted/facet_soup.hpp"

#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::cad {

struct FacetGroupFacts {
  std::string name, part;
  std::int32_t triangles = 0;
  double area = 0;

  static constexpr auto fields() {
    return std::tuple(&FacetGroupFacts::name, &FacetGroupFacts::part, &FacetGroupFacts::triangles,
                      &FacetGroupFacts::area);
  }
};

struct FacetFacts {
  std::string format;
  std::int32_t points = 0;  ///< with different coordinates
  std::int32_t triangles = 0;
  std::int32_t without_area = 0;       ///< triangles whose corners are equal or lie on one line
  std::int32_t open_sides = 0;         ///< of one triangle
  std::int32_t junction_sides = 0;     ///< of three or more
  std::int32_t misoriented_sides = 0;  ///< passed twice in one direction
  std::int32_t components = 0;         ///< what hangs together over sides
  double area = 0;
  double volume = 0;  ///< by the divergence theorem, of the triangles as they are oriented
  geometry::Box bounds;
  std::vector<FacetGroupFacts> groups;

  static constexpr auto fields() {
    return std::tuple(&FacetFacts::format, &FacetFacts::points, &FacetFacts::triangles,
                      &FacetFacts::without_area, &FacetFacts::open_sides, &FacetFacts::junction_sides,
                      &FacetFacts::misoriented_sides, &FacetFacts::components, &FacetFacts::area,
                      &FacetFacts::volume, &FacetFacts::bounds, &FacetFacts::groups);
  }
};

/// Equal points count as one.
FacetFacts look_at_facets(const FacetSoup& soup);

}  // namespace aeroloom::cad
