/// From a level that a case asks for to sizes.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "sizing/choice/model_sampler.hpp"

namespace aeroloom::domain {

struct LevelRequest {
  cases::SizingRequest request;  ///< with the level's bounds in place of the level; those given stay
  sizing::Level level;           ///< the one asked for, or a coarser one that the budget holds
  LevelFindings found;
};

/// Makes the sampler's fields ask for what the level does. Collective. Throws CollectiveError where the model
/// has no lifting body, and where even the coarsest level takes more tetrahedra than the budget.
LevelRequest apply_level(sizing::ModelSampler& sampler, const cases::SizingRequest& request);

}  // namespace aeroloom::domain
