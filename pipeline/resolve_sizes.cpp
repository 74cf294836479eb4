#include "pipeline/resolve_sizes.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::pipeline {

sizing::SizingOptions resolve_sizes(const parallel::Communicator& communicator, const geometry::Model& model,
                                    const SizingRequest& request, parallel::StageClock& clock) {
  sizing::SizingOptions sizes;
  if (!request.minimum || !request.maximum) {
    sizes = sizing::choose_sizes(communicator, model, request.target_tetrahedra, clock);
  }
  if (request.minimum) sizes.minimum = *request.minimum, sizes.feature_minimum = 0;
  if (request.feature_minimum) sizes.feature_minimum = *request.feature_minimum;
  if (request.maximum) sizes.maximum = *request.maximum;
  if (request.curvature_angle) sizes.curvature_angle = *request.curvature_angle;
  if (request.proximity) sizes.proximity = *request.proximity;
  if (request.growth) sizes.growth = *request.growth;
  if (request.surface_maximum) sizes.surface_maximum = *request.surface_maximum;
  if (sizes.minimum > sizes.maximum) {
    throw std::invalid_argument(
        fmt::format("sizing.minimum ({:.6g}) exceeds sizing.maximum ({:.6g}), one of which was chosen from "
                    "the model. Remedy: give both",
                    sizes.minimum, sizes.maximum));
  }
  return sizes;
}

}  // namespace aeroloom::pipeline
