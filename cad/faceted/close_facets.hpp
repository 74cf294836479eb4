/// Open sides of a soup, closed where there is one way to do so.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"

namespace aeroloom::cad {

/// In this order, each only while sides are open: triangles are split where open points lie on their open
/// sides; open points are made one that are nearer to each other than to any side's other end, where that
/// leaves fewer open sides; planar openings are closed. Equal points are one, and no triangle is void
/// (weld_equal_points, drop_void_triangles).
void close_facets(FacetSoup& soup, Changes& changes);

/// Splits triangles at open points that lie exactly on their open sides, or within `tolerance` of them, along
/// a chain of other open sides. Returns the number of triangles split, and adds a change for them.
std::size_t split_open_sides(FacetSoup& soup, double tolerance, Changes& changes);

/// Closes planar openings, all or none. False where one is not planar, too narrow, or too wide for the body
/// around it.
bool cap_facets(FacetSoup& soup, Changes& changes);

/// Throws CadError with the number of open loops, the longest of them and where it lies.
void refuse_open_sides(const FacetSoup& soup);

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
