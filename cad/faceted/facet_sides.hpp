/// The sides of triangles, sorted by end points, and the angles of the surface there. Internal to
/// cad/faceted/.
#pragma once

#include "cad/faceted/facet_soup.hpp"
#include "geometry/half_edges.hpp"
#include "geometry/runs.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::cad {

/// A side as one triangle uses it; low < high.
struct FacetSide {
  std::int32_t low, high;
  geometry::HalfEdge half_edge;
};

inline std::int32_t facet_of(geometry::HalfEdge h) {
  return h / 3;
}

/// The sides of all triangles, ascending by low, high, half-edge.
std::vector<FacetSide> sort_sides(const std::vector<geometry::TriangleCorners>& triangles);

/// Calls visit(passes) for each side with all its uses.
template <class Visit>
void for_each_side(const std::vector<FacetSide>& sides, const Visit& visit) {
  const std::span<const FacetSide> all(sides);
  geometry::for_each_run(
      all, [](const FacetSide& a, const FacetSide& b) { return a.low == b.low && a.high == b.high; },
      [&](std::size_t first, std::size_t last) { visit(all.subspan(first, last - first)); });
}

/// Sides of one triangle only, as half-edges, ascending.
std::vector<geometry::HalfEdge> open_sides(const std::vector<geometry::TriangleCorners>& triangles);

/// Numbers of open sides and of sides with more than two triangles.
struct UnevenSides {
  std::size_t open = 0, many = 0;
};
UnevenSides count_uneven_sides(const std::vector<geometry::TriangleCorners>& triangles);

/// First and last point of a half-edge.
inline std::int32_t side_begin(const std::vector<geometry::TriangleCorners>& triangles,
                               geometry::HalfEdge h) {
  return triangles[h / 3][h % 3];
}
inline std::int32_t side_end(const std::vector<geometry::TriangleCorners>& triangles, geometry::HalfEdge h) {
  return triangles[h / 3][(h % 3 + 1) % 3];
}
/// The corner opposite the side.
inline std::int32_t side_apex(const std::vector<geometry::TriangleCorners>& triangles, geometry::HalfEdge h) {
  return triangles[h / 3][(h % 3 + 2) % 3];
}

/// A side, and its uses in `SideTable::passes`.
struct SideRecord {
  std::int32_t low, high;
  std::int32_t begin, end;
  std::int32_t passes() const { return end - begin; }
};

struct SideTable {
  std::vector<FacetSide> passes;
  std::vector<SideRecord> sides;
  std::vector<std::int32_t> side_of;  ///< per half-edge
};
SideTable make_side_table(const std::vector<geometry::TriangleCorners>& triangles);

/// Angle between the normals of the two triangles of each side, in radians; pi if there are not two.
/// Triangles that are too thin for a reliable normal take that of the neighbour over their longest side.
std::vector<double> measure_turns(const FacetSoup& soup, const SideTable& table);

}  // namespace aeroloom::cad
