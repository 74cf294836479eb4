/// Points and triangles that a soup has twice, and triangles that are none.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::cad {

/// Makes points with equal coordinates one, and drops points that no triangle uses. Nothing moves.
void weld_equal_points(FacetSoup& soup);

/// Gives the corner `p` the point `representative[p]`, and drops points that are not used any more.
void replace_points(FacetSoup& soup, const std::vector<std::int32_t>& representative);

/// Whether the three lie on one line. Exact.
bool on_one_line(Vec3 a, Vec3 b, Vec3 c);

/// Drops triangles with equal corners, with three corners on one line, and all but the first of those with
/// the same corners. The sides of the others stay as they are: a dropped one may leave open sides.
void drop_void_triangles(FacetSoup& soup, Changes& changes);

}  // namespace aeroloom::cad
