#include "pipeline/size_domain.hpp"

#include "cad/model/joined_faces.hpp"
#include "parallel/collective_error.hpp"
#include "sizing/choose_sizes.hpp"
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

/// Sizes as asked for, and the field where it was built on the way to them.
struct ResolvedSizes {
  sizing::SizingOptions sizes;
  std::optional<sizing::ChosenSizes> chosen;
};

ResolvedSizes resolve_sizes(const sizing::ModelSampler& sampler, const SizingRequest& request,
                            const std::optional<sizing::ChosenSizes>& near) {
  ResolvedSizes resolved;
  if (!request.minimum || !request.maximum) {
    const auto near_sizes = near ? std::optional(near->options) : std::nullopt;
    resolved.chosen = sizing::choose_sizes(sampler, request.target_tetrahedra, near_sizes);
    resolved.sizes = resolved.chosen->options;
  }
  sizing::SizingOptions& sizes = resolved.sizes;
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
  return resolved;
}

/// The sized domain of a model that stays as it is.
SizedDomain finish(const cad::Model& model, const sizing::ModelSampler& sampler, ResolvedSizes resolved,
                   cad::Changes joined) {
  const sizing::SizingOptions& sizes = resolved.sizes;
  if (resolved.chosen && resolved.chosen->options == sizes) {
    return {model, sizes, std::move(resolved.chosen->field), std::move(joined), resolved.chosen->counts};
  }
  return {model, sizes, sampler.build_field(sizes), std::move(joined), {}};
}

}  // namespace

SizedDomain size_domain(const parallel::Communicator& communicator, const cad::Model& model,
                        const SizingRequest& request, NarrowFaces narrow_faces, parallel::StageClock& clock) {
  const double layers = request.proximity.value_or(sizing::SizingOptions{}.proximity);
  const sizing::ModelSampler sampler(communicator, model, clock, layers);
  ResolvedSizes resolved = resolve_sizes(sampler, request, {});
  if (narrow_faces == NarrowFaces::keep) return finish(model, sampler, std::move(resolved), {});
  cad::Changes changes;
  const std::optional<cad::Model> joined =
      join_narrow_faces(communicator, model, resolved.sizes.minimum, clock, changes);
  if (!joined) return finish(model, sampler, std::move(resolved), {});
  const sizing::ModelSampler of_joined(communicator, *joined, clock, layers);
  // Without narrow faces, sizes that aim at a number of elements come out a little smaller.
  if (!request.minimum)
    resolved = resolve_sizes(of_joined, request, resolved.chosen);
  else
    resolved.chosen.reset();
  return finish(*joined, of_joined, std::move(resolved), std::move(changes));
}

}  // namespace aeroloom::pipeline
