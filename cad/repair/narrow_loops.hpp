/// Faces over narrow openings that have none, such as blunt trailing edges. Internal to cad/.
#pragma once

#include "cad/repair/plane_loops.hpp"

#include <optional>
#include <vector>

#include <TopoDS_Edge.hxx>

namespace aeroloom::cad {

/// How narrow and how planar.
struct NarrowLimits {
  double planar = 0;  ///< largest distance of the edges from their plane
  double widest = 0;  ///< largest mean width of the face: twice its area over its border's length
};

/// A face over a closed loop of edges, which are oriented and in order: planar, or ruled between two opposite
/// edges of four. It shares the edges. Empty if it is neither, or would be too wide.
std::optional<Cap> span_narrow_loop(const std::vector<TopoDS_Edge>& loop, const NarrowLimits& limits);

}  // namespace aeroloom::cad
