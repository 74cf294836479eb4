/// Lifting bodies of a model (lifting_bodies.hpp): how they are found.
///
/// A trailing edge is a blunt strip, or a sharp edge of the CAD, behind which the body ends against the flow.
/// From each of its places a plane along the flow cuts the skin in front of it: the point of the section that
/// is farthest away is the leading edge, its distance the local chord. What is found depends on the geometry
/// and the direction of the flow alone.
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
