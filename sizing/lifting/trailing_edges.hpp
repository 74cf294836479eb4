/// Blunt trailing edges of a model, with the local chord ahead of each.
#pragma once

#include "cad/model/topology/blunt_edges.hpp"
#include "sizing/choice/sampled_model.hpp"

#include <vector>

namespace aeroloom::sizing {

/// A narrow face of a blunt trailing edge that can be closed, and what closing would mean.
struct TrailingEdge {
  cad::BluntEdge strip;
  double chord = 0;     ///< the shortest local chord along it (local_chord())
  double fraction = 0;  ///< the largest width over the local chord
};

/// Finds trailing edges that are narrower than `width` at some place. In the order of faces, the same on
/// every rank. The model must have no joined faces yet. Collective. Throws CollectiveError where the CAD
/// library fails.
std::vector<TrailingEdge> find_trailing_edges(const SampledModel& sampled, double width);

}  // namespace aeroloom::sizing
