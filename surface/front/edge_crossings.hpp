/// Finds where the edges of a boundary meet although they should not.
#pragma once

#include "surface/front/front.hpp"

#include <vector>

namespace aeroloom::front {

/// All pairs of edges that share a point other than a common vertex: crossing, touching, overlapping, or
/// ending in different vertices at one place. Exact. Pairs ascend, `first` < `second`.
std::vector<CrossingEdges> find_edge_crossings(const FrontInput& boundary);

}  // namespace aeroloom::front
