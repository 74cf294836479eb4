#include "sizing/choice/choose_sizes.hpp"

#include "parallel/observation/log.hpp"
#include "sizing/choice/field_factory.hpp"
#include "sizing/choice/predict_counts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

// The preset fixes these; one length, the size on the body, follows from the target. What nothing else is
// said of was chosen, not measured: for an aircraft in a far field, whose user gives nothing but a file.
constexpr double preset_curvature_angle = 15;
constexpr double preset_growth = 1.3;
/// The smallest size over the widest gap that was sewn: surfaces do not meet there, and an element that
/// bridges the gap is off by a tenth of itself at most.
constexpr double size_over_gap = 10;
constexpr double body_size_over_minimum = 10;
constexpr double out_of_reach = 0.2;        // logarithm of the count over the target
constexpr double domain_over_maximum = 20;  // diagonal of everything
/// The largest extent of the body over sizes on it: the coarsest that is tried, the finest and the first.
constexpr double body_over_coarsest = 5, body_over_finest = 5000, body_over_first = 60;
/// Fields that are built to meet the target (docs/bounds.md), and full ones where coarse ones found nothing
/// near it: each takes as long as that of the mesh.
constexpr int most_rounds = 8, rounds_out_of_reach = 2;
// Of the logarithm of the count over that of the size: near -2 where the surface rules, flatter where small
// features do.
constexpr double first_slope = -2, steepest_slope = -3, flattest_slope = -0.2;
/// Of the logarithm of the size: four times as large or small, beyond which no slope that was measured holds.
constexpr double largest_step = 1.4;
// Far too many, and no fewer over a step that tells: what is given rules, not this size.
constexpr double infeasible = 2, flat = 0.02;  // of the logarithm of the count
// Over a shorter step counts may jump by more than they change: a flat slope says nothing then.
constexpr double least_telling_step = 0.2;
// Of the target. Sizes for a model that is almost the same, and those that coarse fields led to, are taken
// over when they come as near as the second; sizes that only tell which faces are narrow, the third.
constexpr double close_enough = 0.04, near_enough = 0.1, good_enough_to_start = 0.2;
// Where features take more than a twentieth on top of what is aimed at, their ratio is no better known.
constexpr double little_ratio = 1.05, near_enough_with_features = 0.2;
// A field with more leaves than this gives several times the count: it is not built to the end. With fewer
// than the least limit fields take so little that none is given up.
constexpr double leaves_per_tetrahedron = 0.5;
constexpr std::int64_t least_limit = 100'000;
/// Leaves that a limit may be: more than any octree has.
constexpr double most_limit = 1e15;
/// Nothing is sampled either for a field whose faces would be cut into as many parts for each of the leaves
/// of its limit.
constexpr double parts_per_leaf = 8;
/// Below this target fields that show the way have the sizes themselves: with few elements every leaf counts.
/// Above it their sizes are so many times as large, with a 64th of the leaves.
constexpr double few_tetrahedra = 300'000, usual_coarsening = 4;
/// Of faces, for which a field is built without asking first how large it would be; chosen, not
/// measured.
constexpr double most_parts_unasked = 1e6;
/// Fields that tell what each bound does may predict ten million elements at least, whatever the target: what
/// a bound costs shows there. Coarse ones have some 300,000 leaves then.
constexpr double least_told = 1e7;
constexpr std::int64_t most_coarse_leaves = 300'000;
/// The error of a field that was given up.
constexpr double far_too_many = 1e300;

std::int64_t leaves_for(double tetrahedra) {
  return std::max<std::int64_t>(least_limit,
                                std::llround(std::min(most_limit, leaves_per_tetrahedron * tetrahedra)));
}

/// How much larger sizes are than those wanted in fields that only show the way.
double coarsening_for(double target_tetrahedra) {
  return target_tetrahedra < few_tetrahedra ? 1 : usual_coarsening;
}

/// How many tetrahedra a field predicts over what a coarser one does.
double usual_bias(double coarsening) {
  constexpr double median_of_seven_models = 0.55;  // with sizes four times as large
  return coarsening > 1 ? median_of_seven_models : 1;
}

struct Preset {
  double maximum, gap;

  static Preset of(const cad::Model& model) {
    return {model.bounds().diagonal() / domain_over_maximum, model.sewn_gap()};
  }
};

/// Where no feature is finer than the minimum, unless that is given.
SizingOptions sizes_for(double body_size, const Preset& preset, const GivenSizes& given) {
  SizingOptions options;
  options.minimum = std::max(body_size / body_size_over_minimum, size_over_gap * preset.gap);
  options.feature_minimum = options.minimum;
  options.surface_maximum = std::max(body_size, options.minimum);
  options.maximum = std::max(preset.maximum, options.surface_maximum);
  options.curvature_angle = preset_curvature_angle;
  options.growth = preset_growth;
  return with_given(options, given);
}

double largest_extent(const geometry::Box& box) {
  return std::max({box.size().x, box.size().y, box.size().z});
}

double first_size(const FieldFactory& factory) {
  return largest_extent(factory.sampled().body_box()) / body_over_first;
}

/// Searches the size on the body, by fields whose sizes are `coarsening` times as large, where features bring
/// `features.ratio` times the elements that there would be without them.
class Search {
public:
  Search(FieldFactory& factory, double target_tetrahedra, double coarsening,
         const FeatureResolution& features, const GivenSizes& given)
      : _factory(factory),
        _given(given),
        _coarsening(coarsening),
        _features(features),
        _target(std::log(target_tetrahedra)),
        _most_leaves(leaves_for(target_tetrahedra * features.ratio)) {}

  void run(double first_size, double largest_error, int most_rounds) {
    const Preset preset = Preset::of(_factory.model());
    const double extent = largest_extent(_factory.sampled().body_box());
    double finest = std::log(extent / body_over_finest), coarsest = std::log(extent / body_over_coarsest);
    double size = std::clamp(std::log(first_size), finest, coarsest), last_size = 0, last_error = 0;
    double slope = first_slope;
    for (int round = 0; round < most_rounds && std::abs(_error) > largest_error; ++round) {
      const double error = judge(std::exp(size), preset);
      if (round > 0 && last_error < far_too_many && error < far_too_many) {
        const bool is_flat =
            std::abs(error - last_error) < flat && std::abs(size - last_size) >= least_telling_step;
        if (is_flat && error > infeasible) break;
        const double measured = (error - last_error) / (size - last_size);
        const bool tells = measured <= flattest_slope || std::abs(size - last_size) >= least_telling_step;
        if (tells) slope = std::clamp(measured, steepest_slope, flattest_slope);
      }
      (error > 0 ? finest : coarsest) = size;
      last_size = size, last_error = error;
      size -= std::clamp(error / slope, -largest_step, largest_step);
      if (!(size > finest && size < coarsest)) size = 0.5 * (finest + coarsest);
    }
    if (_error == far_too_many) {
      _body_size = std::exp(finest);
      _options = sizes_for(_body_size, preset, _given);
    }
  }

  bool is_out_of_reach() const { return std::abs(_error) > out_of_reach; }
  bool is_infeasible() const { return _error > infeasible; }
  /// The sizes that came nearest to the target; the coarsest tried where all were far too fine.
  const SizingOptions& options() const { return _options; }
  double body_size() const { return _body_size; }
  /// As options(), with the field: of a search by fields that are as fine as asked for.
  ChosenSizes best(FieldFor purpose) {
    if (_best) {
      const PredictedCounts counts{count_triangles(_factory.sampled(), _best->field), _best->tetrahedra};
      return {_options, std::move(_best->field), counts, _features, _body_size};
    }
    ChosenSizes chosen = apply_sizes(_factory, _options, purpose);
    chosen.features = _features;
    chosen.body_size = _body_size;
    return chosen;
  }

private:
  /// The logarithm of the count over the target; 1e300 where there are far too many. What comes nearest is
  /// kept.
  double judge(double body_size, const Preset& preset) {
    SizingOptions options = sizes_for(body_size, preset, _given);
    set_features(options, _features);
    std::optional<Trial> trial;
    std::optional<double> tetrahedra;
    const double most_parts = parts_per_leaf * static_cast<double>(_most_leaves) * _coarsening * _coarsening;
    if (!_factory.has_more_parts(options, most_parts)) {
      if (_coarsening == 1) trial = _factory.try_sizes(options, _most_leaves);
      if (trial) tetrahedra = trial->tetrahedra;
      if (_coarsening > 1) tetrahedra = _factory.estimate_tetrahedra(options, _coarsening, _most_leaves);
    }
    if (!tetrahedra) {
      parallel::log_verbose(fmt::format("sizing: {:.4g} on the body: far too many", body_size));
      return 1e300;
    }
    const double count = std::max(*tetrahedra, 1.0) * usual_bias(_coarsening);
    parallel::log_verbose(fmt::format("sizing: {:.4g} on the body: {}{:.3g} tetrahedra", body_size,
                                      _coarsening > 1 ? "about " : "", count));
    const double error = std::log(count / _features.ratio) - _target;
    if (std::abs(error) < std::abs(_error)) {
      _error = error;
      _options = options;
      _body_size = body_size;
      _best = std::move(trial);
    }
    return error;
  }

  FieldFactory& _factory;
  const GivenSizes& _given;
  double _coarsening;
  FeatureResolution _features;
  double _target;
  std::int64_t _most_leaves;
  double _error = far_too_many, _body_size = 0;
  SizingOptions _options;
  std::optional<Trial> _best;
};

void check_target(double target_tetrahedra) {
  if (target_tetrahedra >= 1) return;
  throw std::invalid_argument(
      fmt::format("sizing: the target must be at least 1 tetrahedron, but it is {}", target_tetrahedra));
}

}  // namespace

SizingOptions estimate_sizes(FieldFactory& factory, double target_tetrahedra, const GivenSizes& given) {
  check_target(target_tetrahedra);
  Search search(factory, target_tetrahedra, coarsening_for(target_tetrahedra), {}, given);
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
  Search base(factory, target_tetrahedra, coarsening, {}, given);
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
  Search search(factory, target_tetrahedra, 1, preliminary.features, given);
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
  const Preset preset = Preset::of(factory.model());
  const double coarsening = coarsening_for(chosen.counts.tetrahedra);
  const auto count = [&](const GivenSizes& these) {
    const auto most =
        std::min(leaves_for(std::max(chosen.counts.tetrahedra, least_told)), most_coarse_leaves);
    const double most_parts = parts_per_leaf * static_cast<double>(most) * coarsening * coarsening;
    if (factory.has_more_parts(sizes_for(chosen.body_size, preset, these), most_parts))
      return std::optional<double>();
    return factory.estimate_tetrahedra(sizes_for(chosen.body_size, preset, these), coarsening, most);
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
