/// How much a faceted surface turns at each side. Seen by this folder only.
#pragma once

#include "cad/faceted/facet_sides.hpp"
#include "cad/faceted/facet_soup.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::cad {

/// A side and its passes in `SideTable::passes`.
struct SideRecord {
  std::int32_t low, high;
  std::int32_t begin, end;
  std::int32_t passes() const { return end - begin; }
};

struct SideTable {
  std::vector<FacetSide> passes;
  std::vector<SideRecord> sides;
  std::vector<std::int32_t> side_of;  ///< of each half-edge
};
SideTable make_side_table(const std::vector<geometry::TriangleCorners>& triangles);

/// Radians between the normals of the two triangles of each side, which run along it in opposite directions;
/// pi where there are not two. Triangles so thin that rounding of the file decides about their normals take
/// that of the neighbour over their longest side.
std::vector<double> measure_turns(const FacetSoup& soup, const SideTable& table);

}  // namespace aeroloom::cad
