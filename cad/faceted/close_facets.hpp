/// Repairs a triangle soup: welds points, drops void triangles, closes openings.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/opening_rules.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// Closes open sides (sides of one triangle only). The steps below run in this order, each while sides are
/// open. Borders are joined. Planar openings are capped. Borders beside each other are joined. Small and
/// narrow openings are filled (fill_openings.hpp), then planar ones capped. Rules come first: openings that
/// they name are closed, or none at all. Equal points must be one, and there may be no void triangles
/// (weld_equal_points, drop_void_triangles).
void close_facets(FacetSoup& soup, OpeningRules& rules, Changes& changes);

/// Splits triangles where open points lie on their open sides. Welds open points that are near each other, if
/// that leaves fewer open sides.
void join_borders(FacetSoup& soup, Changes& changes);
/// Splits open sides at points of borders that run along them, within the tolerances of sewing, if that
/// leaves fewer open sides: then both borders have the points of both.
void join_borders_beside(FacetSoup& soup, Changes& changes);

/// Which points near a side count as on it: those that other open sides connect to a chain from end to end,
/// or those whose own open sides run along it.
enum class NearPoints { in_chain, alongside };

/// Splits triangles at open points on their open sides. With a tolerance, points near a side count too.
/// Returns the number of split triangles and adds one change.
std::size_t split_open_sides(FacetSoup& soup, double tolerance, NearPoints rule, Changes& changes);

/// "cap_1", or the first such name that no cap of the soup has.
std::string next_cap_name(const FacetSoup& soup);

/// Closes all planar openings or none. False if an opening is not planar, too narrow, or too wide for its
/// body.
bool cap_facets(FacetSoup& soup, Changes& changes);

/// Throws CadError if sides are open. It names the number of open loops, the longest loop and its position.
void refuse_open_sides(const FacetSoup& soup);

/// Makes points with equal coordinates one and drops unused points. No coordinate changes.
void weld_equal_points(FacetSoup& soup);

/// Replaces each corner p by `representative[p]` and drops unused points.
void replace_points(FacetSoup& soup, const std::vector<std::int32_t>& representative);

/// Whether three points are collinear. Exact.
bool on_one_line(Vec3 a, Vec3 b, Vec3 c);

/// Drops triangles whose corners are collinear or equal.
void drop_flat_triangles(FacetSoup& soup, Changes& changes);

/// Drops void triangles, whose corners are collinear or equal, and all but the first of triangles with the
/// same corners. This may leave open sides.
void drop_void_triangles(FacetSoup& soup, Changes& changes);

}  // namespace aeroloom::cad
