/// From a domain and what a case says about sizes to the model and the sizes of a run.
#pragma once

#include "cad/model/model.hpp"
#include "cad/repair/change.hpp"
#include "parallel/communicator.hpp"
#include "parallel/timers.hpp"
#include "pipeline/case.hpp"
#include "sizing/size_field.hpp"

namespace aeroloom::pipeline {

/// What the user asked for; the rest is chosen from the model. Bounds that the user gave bind the choice.
/// Throws std::invalid_argument when they contradict what was chosen. Collective.
sizing::SizingOptions resolve_sizes(const parallel::Communicator& communicator, const cad::Model& model,
                                    const SizingRequest& request, parallel::StageClock& clock);

struct SizedDomain {
  cad::Model model;  ///< faces narrower than the smallest size joined with neighbours, if wanted
  sizing::SizingOptions sizes;
  sizing::SizeField field;
  cad::Changes joined;  ///< one for each face that vanished
};

/// Resolves sizes, joins narrow faces (unless told to keep them), and builds the field. The same on every
/// rank. Collective. Throws as resolve_sizes.
SizedDomain size_domain(const parallel::Communicator& communicator, const cad::Model& model,
                        const SizingRequest& request, NarrowFaces narrow_faces, parallel::StageClock& clock);

}  // namespace aeroloom::pipeline
