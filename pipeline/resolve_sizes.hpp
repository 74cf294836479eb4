/// From what a case says about sizes to the sizes of a run.
#pragma once

#include "geometry/model.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "pipeline/case.hpp"
#include "sizing/size_field.hpp"

namespace aeroloom::pipeline {

/// What the user asked for; the rest is chosen from the model. Bounds that the user gave bind the choice.
/// Throws std::invalid_argument when they contradict what was chosen. Collective.
sizing::SizingOptions resolve_sizes(const parallel::Communicator& communicator, const geometry::Model& model,
                                    const SizingRequest& request, parallel::StageClock& clock);

}  // namespace aeroloom::pipeline
