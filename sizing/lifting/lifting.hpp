/// Finds the lifting bodies of a model. `flow`: a unit vector. `named`: patterns of names of faces or
/// patches; only trailing edges of these faces count, or all if there are none. The model must have no joined
/// faces yet. The same on every rank. Collective. Throws parallel::CollectiveError where the CAD library
/// fails.
#pragma once

#include "sizing/choice/sampled_model.hpp"
#include "sizing/features/lifting_bodies.hpp"

#include <string>
#include <vector>

namespace aeroloom::sizing {

/// Finds the lifting bodies of a model. `flow`: a unit vector. `named`: patterns of the names of faces or
/// patches; only trailing edges of these faces are taken, of all where there are none. For the model before
/// any of its faces were joined. The same on every rank; collective. Throws parallel::CollectiveError where
/// the CAD library fails.
LiftingBodies find_lifting_bodies(const SampledModel& sampled, geometry::Vec3 flow,
                                  const std::vector<std::string>& named = {});

}  // namespace aeroloom::sizing
