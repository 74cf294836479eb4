/// How curves begin at sharp corners.
#pragma once

#include "geometry/model.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "sizing/size_field.hpp"

#include <array>
#include <vector>

namespace aeroloom::surface {

/// Per edge and end (at its first and last parameter): how far from the CAD vertex the first vertex on the
/// curve is; 0 where the size field alone decides. Where two edges of a face meet below 30 degrees, both begin
/// with a segment of the same length, which reaches to where elements fit between them: one triangle fills the
/// corner, and the next ones are good. The same on every rank. Collective.
std::vector<std::array<double, 2>> corner_legs(const parallel::Communicator& communicator,
                                               const geometry::Model& model, const sizing::SizeField& field,
                                               parallel::StageClock& clock);

}  // namespace aeroloom::surface
