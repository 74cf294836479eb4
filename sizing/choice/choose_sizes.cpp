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
/// As least_share where gaps take much.
constexpr double least_share_with_gaps = 0.25;
/// Elements without features over the target, from which on these cannot be made fewer.
constexpr double fixed_above = 1.2;
/// Features get this part of the elements at least, where not even these are met.
constexpr double least_for_features = 0.1;
/// Of all elements, those that no feature takes, at least: counts of features are rough.
constexpr double least_rest = 0.1;
/// Elements that gaps may take where that is more than the budget, in all and over the target: gaps that
/// narrow to nothing, as where walls cross, have no least size. Chosen, not measured.
constexpr double most_in_gaps = 1e7, most_gaps_over_target = 500;
/// Sizes on the body over those that counts of features led to, at most; the same where gaps rule.
constexpr double coarsest_over_guess = 3, coarsest_with_gaps = 1.5;
/// Of what a target and its features may take: the rest, at most, where features have to get fewer.
constexpr double most_of_rest = 0.75;
/// Of all: features other than gaps, at least, that it helps to have fewer of.
constexpr double worth_cutting = 0.1;
/// By this budget it is judged whether trailing edges are kept, if a user does not ask for more.
constexpr double budget_of_edges = 5;
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

namespace {

/// The part of the target that is left for everything but features, at least, where gaps take this part.
double least_left_over(double gaps) {
  return std::max(least_share_with_gaps, least_share - std::max(0.0, gaps));
}

/// What features may add to `base` elements. `left`: what is left beside them, over the base.
FeatureBudget budget_for(const PreliminarySizes& preliminary, double base, double left) {
  const double most = preliminary.feature_budget * preliminary.target / base;
  const double gaps = std::min(most_in_gaps, most_gaps_over_target * preliminary.target) / base;
  return {1 + std::max(least_for_features, most - left), std::max(preliminary.feature_budget, gaps)};
}

/// Fills in how many elements are aimed at, features included, and the size on the body for it.
void aim_at(PreliminarySizes& preliminary, double target) {
  const FeatureResolution& features = preliminary.features;
  if (features.ratio == 1) return;
  const double base = preliminary.base;
  const double gaps = (features.gap_ratio - 1) * base / target;
  const double all = (features.ratio - 1) * base / target;
  const double left = std::max(1 - all, least_left_over(gaps));
  preliminary.aimed = (left + all) * target;
  preliminary.body_size *= std::max(1.0, std::pow(target * left / base, -0.5));
}

/// The ratios over the rest of the chosen elements, where features add what they do to the base.
FeatureResolution at_count(const FeatureResolution& features, double base, const ChosenSizes& chosen) {
  const double tetrahedra = chosen.counted();
  const double added = (features.ratio - 1) * base;
  const double rest = std::max(tetrahedra - added, least_rest * tetrahedra);
  const auto over_rest = [&](double ratio) { return 1 + (ratio - 1) * base / rest; };
  FeatureResolution now = features;
  now.minimum = std::max(now.minimum, chosen.options.minimum);
  if (!(now.gap_floor > 0)) now.gap_floor = now.minimum;
  now.ratio = over_rest(features.ratio);
  now.gap_ratio = over_rest(features.gap_ratio);
  now.resolved_ratio = over_rest(features.resolved_ratio);
  return now;
}

}  // namespace

PreliminarySizes preliminary_sizes(FieldFactory& factory, double target_tetrahedra, double feature_budget,
                                   const std::optional<SizingOptions>& near, const GivenSizes& given) {
  check_target(target_tetrahedra);
  const double coarsening = coarsening_for(target_tetrahedra);
  SizeSearch base(factory, target_tetrahedra, coarsening, {}, given);
  const double start = near && !given.surface_maximum ? near->surface_maximum : first_size(factory);
  base.run(start, near ? near_enough : close_enough, most_rounds);
  PreliminarySizes preliminary{
      base.options(),    base.body_size(),  base.is_out_of_reach(), base.is_infeasible(), {},
      target_tetrahedra, target_tetrahedra, target_tetrahedra,      feature_budget};
  if (given.holds_features()) return preliminary;
  // Where all fields were far too large nothing is known of features either.
  if (std::isfinite(base.tetrahedra())) preliminary.base = std::max(target_tetrahedra, base.tetrahedra());
  const double left = preliminary.base > fixed_above * target_tetrahedra ? 1 : least_share;
  preliminary.features =
      choose_feature_resolution(factory, base.options(), budget_for(preliminary, preliminary.base, left),
                                coarsening, leaves_for(target_tetrahedra * budget_of_edges));
  aim_at(preliminary, target_tetrahedra);
  return preliminary;
}

SizingOptions sizes_for_edges(FieldFactory& factory, double target_tetrahedra, double feature_budget,
                              const PreliminarySizes& preliminary, const GivenSizes& given) {
  SizingOptions sizes = preliminary.options;
  if (given.holds_features()) return sizes;
  const double budget = std::max(feature_budget, budget_of_edges);
  set_features(sizes, choose_feature_resolution(factory, sizes, {budget}, coarsening_for(target_tetrahedra),
                                                leaves_for(target_tetrahedra * budget)));
  return sizes;
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

namespace {

/// The sizes where features get what the rest leaves of their budget. The body keeps the size that it had
/// before features were too many, or has the coarsest where that leaves them little.
PreliminarySizes with_fewer_features(FieldFactory& factory, const PreliminarySizes& before, double coarsest,
                                     const GivenSizes& given) {
  const auto try_body = [&](double size) {
    SizeSearch search(factory, before.target, 1, {}, given);
    search.run(size, close_enough, 1);
    return search;
  };
  std::optional<SizeSearch> bare(try_body(before.body_size));
  if (bare->tetrahedra() > most_of_rest * before.feature_budget * before.target)
    bare.emplace(try_body(coarsest));
  PreliminarySizes now = before;
  const double gaps = (before.features.gap_ratio - 1) * before.base;
  now.options = bare->options();
  now.body_size = bare->body_size();
  now.base = std::max(1.0, bare->tetrahedra());
  now.features =
      choose_feature_resolution(factory, now.options, budget_for(now, now.base, 1 + gaps / now.base),
                                coarsening_for(before.target), leaves_for(before.target * budget_of_edges));
  // Where the body has finer elements than a gap here, it may get coarser ones.
  if (now.features.gap_floor == 0) now.features.gap_floor = before.features.gap_floor;
  // Coarse fields see features cost more than they do: the body is not to fill what they promised.
  now.aimed = std::clamp(now.features.ratio * now.base, before.target, before.feature_budget * before.target);
  return now;
}

}  // namespace

ChosenSizes choose_sizes(FieldFactory& factory, const PreliminarySizes& preliminary, const GivenSizes& given,
                         FieldFor purpose) {
  if (preliminary.is_infeasible && purpose == FieldFor::forecast) {
    ChosenSizes applied = apply_sizes(factory, preliminary.with_features(), purpose);
    applied.features = at_count(preliminary.features, preliminary.base, applied);
    applied.body_size = preliminary.body_size;
    return applied;
  }
  const auto search = [&](const PreliminarySizes& from) {
    const double most_over_guess = from.features.gap_ratio > 1 ? coarsest_with_gaps : coarsest_over_guess;
    SizeSearch found(factory, from.aimed, 1, from.features, given);
    found.run(from.body_size, near_enough, from.is_out_of_reach ? rounds_out_of_reach : most_rounds,
              from.features.ratio > 1 ? most_over_guess * from.body_size : 0);
    return found;
  };
  SizeSearch found = search(preliminary);
  const double most = preliminary.feature_budget * preliminary.target;
  // Gaps are resolved whatever the target.
  const double others = (preliminary.features.ratio - preliminary.features.gap_ratio) * preliminary.base;
  if (others < worth_cutting * found.tetrahedra() || found.tetrahedra() <= most ||
      !std::isfinite(found.tetrahedra())) {
    ChosenSizes chosen = found.best(purpose);
    chosen.features = at_count(preliminary.features, preliminary.base, chosen);
    return chosen;
  }
  const PreliminarySizes coarser = with_fewer_features(factory, preliminary, found.body_size(), given);
  ChosenSizes chosen = search(coarser).best(purpose);
  chosen.features = at_count(coarser.features, coarser.base, chosen);
  return chosen;
}

ChosenSizes choose_sizes(FieldFactory& factory, double target_tetrahedra, double feature_budget,
                         const std::optional<SizingOptions>& near, const GivenSizes& given) {
  return choose_sizes(factory, preliminary_sizes(factory, target_tetrahedra, feature_budget, near, given),
                      given);
}

double least_target(const ChosenSizes& chosen) {
  const double all = chosen.counted();
  const double gaps = all * (chosen.features.gap_ratio - 1) / chosen.features.ratio;
  // Beside these a quarter is left.
  return gaps > 0.5 * all ? gaps / (1 - least_share_with_gaps) : all;
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
    const SizingOptions options = sizes_for(chosen.body_size, factory, these);
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
  FieldFactory factory(SampledModel(communicator, model), gap_demand({}), Fields::several);
  return choose_sizes(factory, target_tetrahedra).options;
}

}  // namespace aeroloom::sizing
