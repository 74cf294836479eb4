/// The spaces between triangles: which are material, and what lies on either side of each triangle.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// A space enclosed by triangles; number 0 is the outside, without end.
struct Chamber {
  bool filled = false;
  std::string name;             ///< of a region point in it; empty without
  std::int32_t region = -1;     ///< of filled ones, counted in the order of the file
  std::int32_t component = -1;  ///< of triangles that hang together over sides, whose chamber it is
};

struct Chambers {
  std::vector<Chamber> chambers;
  /// Per triangle the chamber that its counter-clockwise normal points to, and the one behind.
  std::vector<std::array<std::int32_t, 2>> beside;
};

/// Triangles are paired around their sides by exact angles; what belongs together bounds a chamber, from
/// without or as an island in it. No two triangles may meet elsewhere than in common points and sides
/// (find_facet_contacts), and no side may be open. Notes hole and region points that lie outside.
Chambers find_chambers(const FacetSoup& soup, Changes& changes);

}  // namespace aeroloom::cad
