#include "sizing/choice/choose_sizes.hpp"

#include "parallel/observation/log.hpp"
#include "sizing/choice/field_factory.hpp"
#include "sizing/choice/predict_counts.hpp"
#include "sizing/choice/size_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

// Of the target. Sizes for a model that is almost the same, and those that coarse fields led to, are taken
// over when they come as near as the second; sizes that only tell which faces are narrow, the third.
constexpr double close_enough = 0.04, near_enough = 0.1, good_enough_to_start = 0.2;
// Where features take more than a twentieth on top of what is aimed at, their ratio is no better known.
constexpr double little_ratio = 1.05, near_enough_with_features = 0.2;
/// Of faces, for which a field is built without asking first how large it would be; chosen, not
/// measured.
constexpr double most_parts_unasked = 1e6;
/// Fields that tell what each bound does may predict ten million elements at least, whatever the target: what
/// a bound costs shows there. Coarse ones have some 300,000 leaves then.
constexpr double least_told = 1e7;
constexpr std::int64_t most_coarse_leaves = 300'000;

void check_target(double target_tetrahedra) {
  if (target_tetrahedra >= 1) return;
  throw std::invalid_argument(
      fmt::format("sizing: the target must be at least 1 tetrahedron, but it is {}", target_tetrahedra));
}

}  // namespace

SizingOptions estimate_sizes(FieldFactory& factory, double target_tetrahedra, const GivenSizes& given) {
  check_target(target_tetrahedra);
  SizeSearch search(factory, target_tetrahedra, coarsening_for(target_tetrahedra), {}, given);
  search.run(first_size(factory), good_enough_to_start, most_rounds);
  return search.options();
}

SizingOptions PreliminarySizes::with_features() const {
  SizingOptions sizes = options;
  set_features(sizes, features);
  return sizes;
}

PreliminarySizes preliminary_sizes(FieldFactory& factory, double target_tetrahedra, double feature_budget,
                                   const std::optional<SizingOptions>& near, const GivenSizes& given) {
  check_target(target_tetrahedra);
  const double coarsening = coarsening_for(target_tetrahedra);
  SizeSearch base(factory, target_tetrahedra, coarsening, {}, given);
  const double start = near && !given.surface_maximum ? near->surface_maximum : first_size(factory);
  base.run(start, near ? near_enough : close_enough, most_rounds);
  PreliminarySizes preliminary{
      base.options(), base.body_size(), base.is_out_of_reach(), base.is_infeasible(), {}};
  if (!given.holds_features()) {
    preliminary.features = choose_feature_resolution(factory, base.options(), feature_budget, coarsening,
                                                     leaves_for(target_tetrahedra * feature_budget));
  }
  return preliminary;
}

ChosenSizes apply_sizes(FieldFactory& factory, const SizingOptions& options, FieldFor purpose) {
  if (factory.has_more_parts(options, most_parts_unasked)) {
    CoarseField rough = factory.build_coarse_field(options);
    const bool is_large = rough.counts.tetrahedra > least_coarse_forecast;
    if (is_large && purpose == FieldFor::forecast)
      return {options, std::move(rough.field), rough.counts, {}, 0};
    if (is_large) parallel::log_info(fmt::format("sizing: some {:.2g} tetrahedra", rough.counts.tetrahedra));
  }
  SizeField field = factory.build_field(options);
  const PredictedCounts counts = predict_counts(factory.sampled(), field);
  return {options, std::move(field), counts, {}, 0};
}

ChosenSizes choose_sizes(FieldFactory& factory, double target_tetrahedra, const PreliminarySizes& preliminary,
                         const GivenSizes& given, FieldFor purpose) {
  if (preliminary.is_infeasible && purpose == FieldFor::forecast) {
    ChosenSizes applied = apply_sizes(factory, preliminary.with_features(), purpose);
    applied.features = preliminary.features;
    applied.body_size = preliminary.body_size;
    return applied;
  }
  SizeSearch search(factory, target_tetrahedra, 1, preliminary.features, given);
  search.run(preliminary.body_size,
             preliminary.features.ratio > little_ratio ? near_enough_with_features : near_enough,
             preliminary.is_out_of_reach ? rounds_out_of_reach : most_rounds);
  return search.best(purpose);
}

ChosenSizes choose_sizes(FieldFactory& factory, double target_tetrahedra, double feature_budget,
                         const std::optional<SizingOptions>& near, const GivenSizes& given) {
  return choose_sizes(factory, target_tetrahedra,
                      preliminary_sizes(factory, target_tetrahedra, feature_budget, near, given), given);
}

std::vector<BoundCost> costs_of_given(FieldFactory& factory, const ChosenSizes& chosen,
                                      const GivenSizes& given) {
  using Bound = std::optional<double> GivenSizes::*;
  static constexpr std::array<std::pair<const char*, Bound>, 9> bounds{{
      {"minimum", &GivenSizes::minimum},
      {"feature_minimum", &GivenSizes::feature_minimum},
      {"maximum", &GivenSizes::maximum},
      {"surface_maximum", &GivenSizes::surface_maximum},
      {"curvature_angle", &GivenSizes::curvature_angle},
      {"chordal_deviation", &GivenSizes::chordal_deviation},
      {"growth", &GivenSizes::growth},
      {"proximity", &GivenSizes::proximity},
      {"gap_proximity", &GivenSizes::gap_proximity},
  }};
  if (std::none_of(bounds.begin(), bounds.end(),
                   [&](const auto& each) { return (given.*each.second).has_value(); }))
    return {};
  const double coarsening = coarsening_for(chosen.counts.tetrahedra);
  const auto count = [&](const GivenSizes& these) {
    const auto most =
        std::min(leaves_for(std::max(chosen.counts.tetrahedra, least_told)), most_coarse_leaves);
    const SizingOptions options = sizes_for(chosen.body_size, factory.model(), these);
    if (factory.has_more_parts(options, most_parts_for(most, coarsening))) return std::optional<double>();
    return factory.estimate_tetrahedra(options, coarsening, most);
  };
  const std::optional<double> all = count(given);
  const auto over = [&](const std::optional<double>& without) {
    if (!without) return 1.0;
    return all ? *all / std::max(1.0, *without) : std::numeric_limits<double>::infinity();
  };
  std::vector<BoundCost> costs;
  if (given.minimum && !given.feature_minimum) {
    GivenSizes bound = given;
    bound.feature_minimum = given.minimum;
    costs.push_back({of_features, over(count(bound))});
  }
  for (const auto& [name, bound] : bounds) {
    if (!(given.*bound)) continue;
    GivenSizes others = given;
    (others.*bound).reset();
    costs.push_back({name, over(count(others))});
  }
  return costs;
}

SizingOptions choose_sizes(const parallel::Communicator& communicator, const cad::Model& model,
                           double target_tetrahedra) {
  FieldFactory factory(SampledModel(communicator, model), SizingOptions{}.proximity, Fields::several);
  return choose_sizes(factory, target_tetrahedra).options;
}

}  // namespace aeroloom::sizing
