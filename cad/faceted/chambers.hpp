/// Finds the spaces that triangles enclose, decides which are material, and says what lies on either side of
/// each triangle.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/faceted/solid_nesting.hpp"
#include "cad/repair/change.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// A space enclosed by triangles. Number 0 is the unbounded space outside.
struct Chamber {
  bool filled = false;
  std::string name;          ///< of a region point inside; empty without one
  std::int32_t solid = -1;   ///< the solid that fills it; -1 where a file says otherwise what is filled
  std::int32_t region = -1;  ///< number among filled chambers, in the order of the file
};

struct Chambers {
  std::vector<Chamber> chambers;
  /// Per triangle: the chamber on the side of its counter-clockwise normal, and the one behind.
  std::vector<std::array<std::int32_t, 2>> beside;
  std::int32_t nested = 0;  ///< number of solids within others that are regions
};

/// Pairs triangles around their common sides by exact angles. Connected pairs bound a chamber, from outside
/// or as an island in it. Triangles may meet in common points and sides only (list_facet_contacts), and no
/// side may be open. Solids decide which chambers are material (nest_solids), or the hole points of TetGen's
/// formats. Hole points and region points outside all chambers are listed as changes.
Chambers find_chambers(const FacetSoup& soup, const FacetSolids& solids, const NestingRules& rules,
                       Changes& changes);

}  // namespace aeroloom::cad
