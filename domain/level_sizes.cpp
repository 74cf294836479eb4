#include "domain/level_sizes.hpp"

#include "aeroloom/parallel/communication/collective_error.hpp"
#include "aeroloom/parallel/observation/log.hpp"
#include "aeroloom/sizing/level_demands.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::domain {
namespace {

/// The request with bounds of a level where the user gave none.
cases::SizingRequest with_bounds(const cases::SizingRequest& request, const sizing::GivenSizes& bounds) {
  cases::SizingRequest result = request;
  const auto fill = [&](std::optional<double> sizing::GivenSizes::*bound) {
    if (!(result.*bound)) result.*bound = bounds.*bound;
  };
  for (const auto bound : {&sizing::GivenSizes::minimum, &sizing::GivenSizes::maximum,
                           &sizing::GivenSizes::feature_minimum, &sizing::GivenSizes::surface_maximum,
                           &sizing::GivenSizes::growth, &sizing::GivenSizes::curvature_angle})
    fill(bound);
  // What a user gives binds what follows from the level.
  result.minimum = std::min(*result.minimum, *result.surface_maximum);
  result.maximum = std::max(*result.maximum, *result.minimum);
  result.level.reset();
  return result;
}

}  // namespace

cases::SizingRequest apply_level(sizing::ModelSampler& sampler, const cases::SizingRequest& request) {
  const geometry::Vec3 flow = normalized(request.flow.value_or(cases::default_flow));
  const sizing::LiftingBodies bodies = sizing::find_lifting_bodies(sampler, flow);
  if (bodies.elements.empty())
    throw parallel::CollectiveError(
        parallel::FailureKind::input,
        fmt::format("sizing.level: no trailing edge was found behind which a body ends along the flow "
                    "({:.3g}, {:.3g}, {:.3g}): neither a blunt strip nor a sharp edge of the CAD. Remedy: "
                    "sizing.flow, the direction of the flow, or sizes of your own in place of the level",
                    flow.x, flow.y, flow.z));
  const sizing::LevelSizes level = sizing::sizes_of(*request.level, request.family, request.solver);
  sampler.demand(sizing::level_lines(sampler.model(), bodies, level, flow));
  cases::SizingRequest result = with_bounds(request, sizing::level_bounds(sampler.model(), bodies, level));
  if (sampler.communicator().is_root())
    parallel::log_info(fmt::format(
        "sizing: level {}: {} trailing edges, reference chord {:.4g}, semispan {:.4g}; {:.3g} % of the local "
        "chord at leading and trailing edges, at most {:.3g} on walls, growth {:.3g}",
        sizing::name_of(*request.level), bodies.elements.size(), bodies.reference_chord, bodies.semispan,
        100 * level.edge, *result.surface_maximum, *result.growth));
  return result;
}

}  // namespace aeroloom::domain
