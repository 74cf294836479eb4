/// Fills openings of a faceted surface with triangles between their own points. Internal to cad/faceted/.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "cad/repair/change.hpp"
#include "cad/repair/opening_rules.hpp"
#include "geometry/half_edges.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aeroloom::cad {

/// A loop of open sides, whose points are numbers in the soup. None occurs twice.
using OpenLoop = std::vector<std::int32_t>;

struct OpenSide {
  std::array<std::int32_t, 2> points;
  std::int32_t triangle;
};
std::vector<OpenSide> list_open_sides(const FacetSoup& soup);

/// Joins open sides to loops. Where several loops meet in a point, sides that enclose no triangles and the
/// smallest angle follow each other. Empty if an odd number of sides ends at a point, which is then `place`.
std::optional<std::vector<OpenLoop>> trace_open_loops(const FacetSoup& soup, std::span<const OpenSide> sides,
                                                      std::int32_t& place);

/// Whether a chord between two corners of the polygon may be a side of a triangle.
using ChordRule = std::function<bool(std::int32_t, std::int32_t)>;

/// Triangles between the corners of a polygon in space, whose sum of areas is small, and of squared sides
/// too. They run as the polygon does, and none has its corners on one line. At most some 160 corners are
/// weighed at once (Barequet, Sharir, Comput. Aided Geom. Des. 12, 1995, doi:10.1016/0167-8396(94)00011-G);
/// longer polygons are first cut along short chords. Empty if there are no such triangles.
std::vector<geometry::TriangleCorners> span_polygon(std::span<const geometry::Vec3> corners,
                                                    const ChordRule& allowed);

/// Fills openings that are small or narrow. Small ones have a few sides and are short beside the body; they
/// join a group beside them. Narrow ones have a mean width below `tolerances::widest_ruled` of the diagonal,
/// and become caps. Two loops beside each other, as of an end
/// that is not welded, are one opening. What triangles would cross stays open, as all others do.
void fill_openings(FacetSoup& soup, Changes& changes);

/// Closes the openings that the rules name, whatever their width, by caps. Throws CadError where these would
/// cross other triangles.
void close_named_openings(FacetSoup& soup, OpeningRules& rules, Changes& changes);

/// Names of the groups of the triangles at open sides between points of the loop.
std::vector<std::string> names_beside(const FacetSoup& soup, std::span<const std::int32_t> points);

}  // namespace aeroloom::cad
