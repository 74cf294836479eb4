/// Finds the lifting bodies of a model (lifting_bodies.hpp).
///
/// A trailing edge is blunt, a narrow face, or it is a sharp CAD edge. Behind it the body ends against the
/// flow. At each place of it, a plane along the flow cuts the skin ahead. The farthest point of this section
/// is the leading edge, its distance the local chord. The result depends on the geometry and on the direction
/// of the flow alone.
#pragma once

#include "sizing/choice/sampled_model.hpp"
#include "sizing/features/lifting_bodies.hpp"

#include <string>
#include <vector>

namespace aeroloom::sizing {

/// Finds the lifting bodies of a model. `flow`: a unit vector. `named`: patterns of names of faces or
/// patches; only trailing edges of these faces count, or all if there are none. The model must have no joined
/// faces yet. The same on every rank. Collective. Throws parallel::CollectiveError where the CAD library
/// fails.
LiftingBodies find_lifting_bodies(const SampledModel& sampled, geometry::Vec3 flow,
                                  const std::vector<std::string>& named = {});

}  // namespace aeroloom::sizing
