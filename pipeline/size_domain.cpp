#include "pipeline/size_domain.hpp"

#include "cad/model/joined_faces.hpp"
#include "parallel/collective_error.hpp"
#include "sizing/narrow_faces.hpp"

#include <optional>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

/// Of the smallest size: how far the mesh may leave the surface where a narrow face vanishes.
constexpr double join_tolerance = 0.05;

/// The model without faces narrower than `width`, where neighbours can take them in.
std::optional<cad::Model> join_narrow_faces(const parallel::Communicator& communicator,
                                            const cad::Model& model, double width,
                                            parallel::StageClock& clock, cad::Changes& changes) {
  const double tolerance = join_tolerance * width;
  std::vector<sizing::NarrowFace> narrow =
      sizing::find_narrow_faces(communicator, model, width, tolerance, clock);
  if (narrow.empty()) return std::nullopt;
  std::optional<cad::Model> joined;
  parallel::agree(communicator, [&] {
    const parallel::ScopedCpu cpu(clock, parallel::ScopedCpu::As::serial);
    joined = cad::join_faces(model, sizing::group_narrow_faces(model, narrow, tolerance));
  });
  for (const sizing::NarrowFace& each : narrow) {
    changes.push_back(
        {fmt::format("face '{}' is {:.3g} wide, less than the smallest size, and was joined with "
                     "'{}', from which it turns by {:.2g} degrees",
                     model.face(each.face).name, each.width, model.face(each.into).name, each.degrees),
         each.place, each.deviation});
  }
  return joined;
}

}  // namespace

sizing::SizingOptions resolve_sizes(const parallel::Communicator& communicator, const cad::Model& model,
                                    const SizingRequest& request, parallel::StageClock& clock) {
  sizing::SizingOptions sizes;
  if (!request.minimum || !request.maximum) {
    sizes = sizing::choose_sizes(communicator, model, request.target_tetrahedra, clock);
  }
  if (request.minimum) sizes.minimum = *request.minimum, sizes.feature_minimum = 0;
  if (request.feature_minimum) sizes.feature_minimum = *request.feature_minimum;
  if (request.maximum) sizes.maximum = *request.maximum;
  if (request.curvature_angle) sizes.curvature_angle = *request.curvature_angle;
  if (request.chordal_deviation) sizes.chordal_deviation = *request.chordal_deviation;
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

SizedDomain size_domain(const parallel::Communicator& communicator, const cad::Model& model,
                        const SizingRequest& request, NarrowFaces narrow_faces, parallel::StageClock& clock) {
  sizing::SizingOptions sizes = resolve_sizes(communicator, model, request, clock);
  cad::Changes changes;
  std::optional<cad::Model> joined;
  if (narrow_faces == NarrowFaces::join) {
    joined = join_narrow_faces(communicator, model, sizes.minimum, clock, changes);
  }
  if (!joined) return {model, sizes, sizing::build_size_field(communicator, model, sizes, clock), {}};
  // Without them, sizes that aim at a number of elements come out a little smaller.
  if (!request.minimum) sizes = resolve_sizes(communicator, *joined, request, clock);
  sizing::SizeField field = sizing::build_size_field(communicator, *joined, sizes, clock);
  return {std::move(*joined), sizes, std::move(field), std::move(changes)};
}

}  // namespace aeroloom::pipeline
