/// From a level that a case asks for to sizes.
#pragma once

#include "aeroloom/case/case.hpp"
#include "aeroloom/domain/size_domain.hpp"
#include "aeroloom/sizing/model_sampler.hpp"

namespace aeroloom::domain {

/// Makes the sampler's fields ask for what the level does, and returns the request with its bounds in place
/// of the level; those that the user gave stay. Collective. Throws CollectiveError where the model has no
/// lifting body.
cases::SizingRequest apply_level(sizing::ModelSampler& sampler, const cases::SizingRequest& request);

}  // namespace aeroloom::domain
