/// Finds the spaces that triangles enclose, decides which are material, and says what lies on either side of
/// each triangle.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// A space enclosed by triangles. Number 0 is the unbounded space outside.
struct Chamber {
  bool filled = false;
  std::string name;             ///< name of a region point inside; empty without one
  std::int32_t region = -1;     ///< number among filled chambers, in the order of the file
  std::int32_t component = -1;  ///< the connected set of triangles that bounds it
};

struct Chambers {
  std::vector<Chamber> chambers;
  /// Per triangle: the chamber on the side of its counter-clockwise normal, and the one behind.
  std::vector<std::array<std::int32_t, 2>> beside;
};

/// Pairs triangles around their common sides by exact angles. Connected pairs bound a chamber, from outside
/// or as an island in it. Triangles may meet in common points and sides only (find_facet_contacts), and no
/// side may be open. Hole points and region points outside all chambers are listed as changes.
Chambers find_chambers(const FacetSoup& soup, Changes& changes);

}  // namespace aeroloom::cad
