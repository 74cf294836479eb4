/// Faces over narrow openings that have none, such as blunt trailing edges. Internal to cad/.
#pragma once

#include "cad/repair/plane_loops.hpp"

#include <vector>

#include <TopoDS_Edge.hxx>

namespace aeroloom::cad {

/// How narrow and how planar.
struct NarrowLimits {
  double planar = 0;  ///< largest distance of the edges from their plane
  double widest = 0;  ///< largest mean width of the face: twice its area over its border's length
};

/// Faces over a closed loop of edges, which are oriented and in order: planar, or ruled between two opposite
/// edges of four. Longer loops are first cut along the shortest lines between vertices that face each other,
/// as at the kinks of a wing's trailing edge. They share the edges. Empty if a part is neither, or too wide.
std::vector<Cap> span_narrow_loop(const std::vector<TopoDS_Edge>& loop, const NarrowLimits& limits);

}  // namespace aeroloom::cad
