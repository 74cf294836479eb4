/// Turns the level of a case into sizes.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/domain/size_domain.hpp"
#include "sizing/choice/field_factory.hpp"

namespace aeroloom::domain {

struct LevelRequest {
  cases::SizingRequest request;  ///< without level: its bounds fill what the case leaves open
  sizing::Level level;           ///< that of the case, or a coarser one within the budget
  LevelFindings found;
};

/// Adds the sizes of the level to the fields of the factory. Collective. Throws CollectiveError if the model
/// has no lifting body, or if even the coarsest level exceeds the budget.
LevelRequest apply_level(sizing::FieldFactory& factory, const cases::SizingRequest& request);

}  // namespace aeroloom::domain
