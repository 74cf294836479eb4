/// From a level that a case asks for to sizes.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "sizing/choice/field_factory.hpp"

namespace aeroloom::domain {

struct LevelRequest {
  cases::SizingRequest request;  ///< with the level's bounds in place of the level; those given stay
  sizing::Level level;           ///< the one asked for, or a coarser one that the budget holds
  LevelFindings found;
};

/// Makes the factory's fields ask for what the level does. Collective. Throws CollectiveError where the model
/// has no lifting body, and where even the coarsest level takes more tetrahedra than the budget.
LevelRequest apply_level(sizing::FieldFactory& factory, const cases::SizingRequest& request);

}  // namespace aeroloom::domain
