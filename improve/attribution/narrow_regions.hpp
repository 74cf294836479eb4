/// Narrow regions: places where two curves of a CAD face are closer than the elements along them, so that
/// single boundary triangles reach from curve to curve, or between the strands of one that turns back.
#pragma once

#include "improve/attribution/curve_wedges.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::attribution {

/// An edge across a narrow region.
struct NarrowEdge {
  std::int64_t edge;  ///< its number in the list of edges
  std::int32_t face;  ///< CAD face of the region
  double width;       ///< height of the narrowest triangle there that has the edge
  geometry::Vec3 at;  ///< its middle
};

/// Finds the edges of the list (ascending, the same on every rank) that run across narrow regions. There a
/// triangle has two vertices on one curve and the third on another, which at a CAD vertex must run along it.
/// Its height is at most 0.4 of the side on the curve. Or all three are on one curve that turns back: just
/// one side runs along the curve, with the height over it as before, or two do and enclose at most 30
/// degrees. (A curve that merely bends has triangles beside it with two sides on it.) The mesh tells which
/// curves meet at a CAD vertex: a curve is where triangles of two CAD faces meet. Each edge comes once, by
/// number. Collective; the same on every rank.
std::vector<NarrowEdge> find_narrow_edges(const mesh::NumberedMesh& mesh, const std::vector<EdgeName>& edges);

/// The entry of an edge in such a list; null where there is none.
const NarrowEdge* find_narrow_edge(const std::vector<NarrowEdge>& narrow, std::int64_t edge);

}  // namespace aeroloom::attribution
