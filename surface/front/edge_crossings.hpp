/// Finds boundary edges that cross or touch.
#pragma once

#include "surface/front/front.hpp"

#include <vector>

namespace aeroloom::front {

/// All pairs of edges that have a point in common other than a vertex of both: they cross, touch, overlap, or
/// end in different vertices at one place. Exact. Pairs ascend, `first` < `second`.
std::vector<CrossingEdges> find_edge_crossings(const FrontInput& boundary);

}  // namespace aeroloom::front
