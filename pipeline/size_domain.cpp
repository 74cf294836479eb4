#include "pipeline/size_domain.hpp"

#include "cad/model/joined_faces.hpp"
#include "parallel/collective_error.hpp"
#include "parallel/log.hpp"
#include "sizing/choose_sizes.hpp"
#include "sizing/narrow_faces.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::pipeline {
namespace {

/// Of the smallest size: how far the mesh may leave the surface where a narrow face vanishes.
constexpr double join_tolerance = 0.05;
/// Tetrahedra predicted over those aimed at, or the other way round, from which on a warning says so.
constexpr double missed_target = 1.25;
/// Logarithm of what a key does to the count, from which on it is named.
constexpr double telling_cost = 0.2;

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

/// What the sizes that are not given are to meet; nothing where no question is left.
std::optional<double> target_of(const SizingRequest& request) {
  if (request.target_tetrahedra) return request.target_tetrahedra;
  return request.minimum && request.maximum ? std::nullopt : std::optional(default_target);
}

std::string describe(const sizing::BoundCost& cost) {
  const std::string what = cost.bound == sizing::of_features
                               ? "features finer than sizing.minimum (bounded by sizing.feature_minimum)"
                               : "sizing." + cost.bound;
  const char* verb = cost.bound == sizing::of_features ? "make" : "makes";
  return std::isinf(cost.ratio) ? fmt::format("{} {} it far too many", what, verb)
                                : fmt::format("{} {} it {:.2g} times as many", what, verb, cost.ratio);
}

/// Which given keys leave no room, where none does so alone.
std::string describe_all(const std::vector<sizing::BoundCost>& costs) {
  std::string names;
  for (const sizing::BoundCost& cost : costs) {
    if (cost.bound == sizing::of_features) continue;
    names += (names.empty() ? "sizing." : ", sizing.") + cost.bound;
  }
  return names.empty() ? "" : "what is given leaves no other choice (" + names + ")";
}

/// What each given key does to the count, those first that do most.
std::string describe_costs(std::vector<sizing::BoundCost> costs) {
  const auto weight = [](const sizing::BoundCost& cost) { return std::abs(std::log(cost.ratio)); };
  std::stable_sort(costs.begin(), costs.end(),
                   [&](const auto& a, const auto& b) { return weight(a) > weight(b); });
  std::string text;
  for (const sizing::BoundCost& cost : costs) {
    if (weight(cost) < telling_cost) break;
    text += (text.empty() ? "" : ", ") + describe(cost);
  }
  return text.empty() ? describe_all(costs) : text;
}

/// Warns where no sizes come near what was aimed at, with the keys that forbid it.
void tell_missed_target(const sizing::ModelSampler& sampler, const parallel::Communicator& communicator,
                        const sizing::ChosenSizes& chosen, const SizingRequest& request, double target) {
  const double ratio = chosen.counts.tetrahedra / chosen.features.share / target;
  if (ratio < missed_target && ratio > 1 / missed_target) return;
  const std::string costs = describe_costs(sizing::costs_of_given(sampler, chosen, request));
  if (!communicator.is_root()) return;
  const char* remedy = ratio > 1 ? "a far field that is nearer (farfield.extent), a larger sizing.growth or "
                                   "larger sizes make it fewer"
                                 : "smaller sizes (sizing.surface_maximum, sizing.maximum) make it more";
  parallel::log_warning(fmt::format(
      "sizing: sizing.target_tetrahedra is {:.3g}, but about {:.2g} tetrahedra are predicted{}{}: {}", target,
      chosen.counts.tetrahedra, costs.empty() ? "" : "; ", costs, remedy));
}

/// The sized domain of the sampler's model, which stays as it is.
SizedDomain finish(const parallel::Communicator& communicator, const sizing::ModelSampler& sampler,
                   const SizingRequest& request, const std::optional<sizing::SizingOptions>& near,
                   JoinedFaces joined) {
  const std::optional<double> target = target_of(request);
  if (!target) {
    const sizing::SizingOptions sizes = sizing::with_given({}, request);
    sizing::SizeField field = sampler.build_field(sizes);
    const sizing::PredictedCounts counts = sampler.predict(field);
    return {sampler.model(),
            sizes,
            std::move(field),
            std::move(joined),
            counts,
            {},
            report_bounded_faces(sampler, sizes),
            {}};
  }
  sizing::ChosenSizes chosen = sizing::choose_sizes(sampler, *target, request.feature_budget, near, request);
  tell_missed_target(sampler, communicator, chosen, request, *target);
  std::optional<FeatureReport> features;
  if (!request.holds_features())
    features = report_features(sampler, chosen.features, chosen.counts.tetrahedra);
  std::vector<NamedBound> bounded = report_bounded_faces(sampler, chosen.options);
  return {sampler.model(), chosen.options,      std::move(chosen.field), std::move(joined),
          chosen.counts,   std::move(features), std::move(bounded),      {}};
}

}  // namespace

void require_walls_apart(const SizedDomain& sized) {
  const std::string text = describe(sized.walls.coincident);
  if (!text.empty()) throw parallel::CollectiveError(parallel::FailureKind::input, text);
}

SizedDomain size_domain(const parallel::Communicator& communicator, const cad::Model& model,
                        const SizingRequest& request, NarrowFaces narrow_faces, parallel::StageClock& clock) {
  const double layers = request.proximity.value_or(sizing::SizingOptions{}.proximity);
  const std::optional<double> target = target_of(request);
  const auto fields = target ? sizing::Fields::several : sizing::Fields::one;
  sizing::ModelSampler sampler(communicator, model, clock, layers, fields);
  const std::vector<sizing::CoincidentFaces> coincident = sampler.find_coincident_faces();
  const auto finish_with = [&](const sizing::ModelSampler& last,
                               const std::optional<sizing::SizingOptions>& near, JoinedFaces what) {
    SizedDomain sized = finish(communicator, last, request, near, std::move(what));
    sized.walls = report_walls(model, coincident, last, sized.field);
    return sized;
  };
  if (narrow_faces == NarrowFaces::keep) return finish_with(sampler, {}, {});
  // Which faces are narrow is told by an estimate; sizes are chosen for what is left of the model.
  std::optional<sizing::SizingOptions> near;
  if (target) near = sizing::estimate_sizes(sampler, *target, request);
  const double width = near ? near->minimum : *request.minimum;
  JoinedFaces what;
  const std::optional<cad::Model> joined = join_narrow_faces(communicator, model, width, clock, what);
  if (!joined) return finish_with(sampler, near, {});
  const sizing::ModelSampler of_joined(std::move(sampler), *joined);
  return finish_with(of_joined, near, std::move(what));
}

}  // namespace aeroloom::pipeline
