/// Blunt trailing edges of a model with the chord of what ends in them.
#pragma once

#include "cad/model/topology/blunt_edges.hpp"
#include "sizing/choice/sampled_model.hpp"

#include <vector>

namespace aeroloom::sizing {

/// A strip that can be closed, and what that would mean.
struct TrailingEdge {
  cad::BluntEdge strip;
  double chord = 0;  ///< the local chord (local_chord()), the shortest along the strip
  double share = 0;  ///< of the local chord that the strip is wide, at most
};

/// Trailing edges narrower than `width` at some place, by face; the same on every rank. Before the sampler's
/// facets go on to a joined model. Collective. Throws CollectiveError where the CAD library fails.
std::vector<TrailingEdge> find_trailing_edges(const SampledModel& sampled, double width);

}  // namespace aeroloom::sizing
