#include "pipeline/size_domain.hpp"

#include "cad/model/joined_faces.hpp"
#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "sizing/choose_sizes.hpp"
#include "sizing/narrow_faces.hpp"

#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

/// Of the smallest size: how far the mesh may leave the surface where a narrow face vanishes.
constexpr double join_tolerance = 0.05;
/// Tetrahedra predicted over those aimed at, or the other way round, from which on a warning says so.
constexpr double missed_target = 1.5;

/// The model without faces narrower than `width`, where neighbours can take them in.
std::optional<cad::Model> join_narrow_faces(const parallel::Communicator& communicator,
                                            const cad::Model& model, double width,
                                            parallel::StageClock& clock, JoinedFaces& what) {
  const double tolerance = join_tolerance * width;
  std::vector<sizing::NarrowFace> narrow =
      sizing::find_narrow_faces(communicator, model, width, tolerance, clock);
  if (narrow.empty()) return std::nullopt;
  std::optional<cad::Model> joined;
  parallel::agree(communicator, [&] {
    const parallel::ScopedCpu cpu(clock, parallel::ScopedCpu::As::serial);
    what.groups = sizing::group_narrow_faces(model, narrow, tolerance);
    joined = cad::join_faces(model, what.groups);
  });
  for (const sizing::NarrowFace& each : narrow) {
    what.changes.push_back(
        {fmt::format("face '{}' is {:.3g} wide, less than the smallest size, and was joined with "
                     "'{}', from which it turns by {:.2g} degrees",
                     model.face(each.face).name, each.width, model.face(each.into).name, each.degrees),
         each.place, each.deviation});
  }
  return joined;
}

bool leaves_a_choice(const SizingRequest& request) {
  return !request.minimum || !request.maximum;
}

/// What was chosen, overruled by what was asked for.
sizing::SizingOptions overrule(const sizing::SizingOptions& chosen, const SizingRequest& request) {
  sizing::SizingOptions sizes = chosen;
  if (request.minimum) {
    sizes.minimum = *request.minimum;
    sizes.feature_minimum = sizes.strip_minimum = sizes.gap_minimum = 0;
  }
  if (request.feature_minimum) sizes.feature_minimum = *request.feature_minimum, sizes.strip_minimum = 0;
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

/// Warns where no sizes come near what was aimed at.
void tell_missed_target(const parallel::Communicator& communicator, const sizing::ChosenSizes& chosen,
                        double target) {
  const double ratio = chosen.counts.tetrahedra / chosen.features.share / target;
  if (!communicator.is_root() || (ratio < missed_target && ratio > 1 / missed_target)) return;
  parallel::log_warning(
      fmt::format("sizing: sizing.target_tetrahedra is {:.3g}, but about {:.2g} tetrahedra are predicted: {}",
                  target, chosen.counts.tetrahedra,
                  ratio > 1 ? "a far field that is nearer (farfield.extent), a larger sizing.growth or "
                              "sizes that are given make it fewer"
                            : "sizes that are given (sizing.surface_maximum, sizing.maximum) make it more"));
}

/// The sized domain of the sampler's model, which stays as it is.
SizedDomain finish(const parallel::Communicator& communicator, const sizing::ModelSampler& sampler,
                   const SizingRequest& request, const std::optional<sizing::SizingOptions>& near,
                   JoinedFaces joined) {
  if (!leaves_a_choice(request)) {
    const sizing::SizingOptions sizes = overrule({}, request);
    return {sampler.model(), sizes, sampler.build_field(sizes), std::move(joined), {}, {}};
  }
  sizing::ChosenSizes chosen =
      sizing::choose_sizes(sampler, request.target_tetrahedra, request.feature_budget, near);
  const sizing::SizingOptions sizes = overrule(chosen.options, request);
  if (sizes != chosen.options)
    return {sampler.model(), sizes, sampler.build_field(sizes), std::move(joined), {}, {}};
  tell_missed_target(communicator, chosen, request.target_tetrahedra);
  FeatureReport features = report_features(sampler, chosen.features, chosen.counts.tetrahedra);
  return {sampler.model(),   sizes,         std::move(chosen.field),
          std::move(joined), chosen.counts, std::move(features)};
}

}  // namespace

SizedDomain size_domain(const parallel::Communicator& communicator, const cad::Model& model,
                        const SizingRequest& request, NarrowFaces narrow_faces, parallel::StageClock& clock) {
  const double layers = request.proximity.value_or(sizing::SizingOptions{}.proximity);
  const auto fields = leaves_a_choice(request) ? sizing::Fields::several : sizing::Fields::one;
  sizing::ModelSampler sampler(communicator, model, clock, layers, fields);
  if (narrow_faces == NarrowFaces::keep) return finish(communicator, sampler, request, {}, {});
  // Which faces are narrow is told by an estimate; sizes are chosen for what is left of the model.
  std::optional<sizing::SizingOptions> near;
  if (leaves_a_choice(request)) near = sizing::estimate_sizes(sampler, request.target_tetrahedra);
  const double width = overrule(near.value_or(sizing::SizingOptions{}), request).minimum;
  JoinedFaces what;
  const std::optional<cad::Model> joined = join_narrow_faces(communicator, model, width, clock, what);
  if (!joined) return finish(communicator, sampler, request, near, {});
  const sizing::ModelSampler of_joined(std::move(sampler), *joined);
  return finish(communicator, of_joined, request, near, std::move(what));
}

}  // namespace aeroloom::pipeline
