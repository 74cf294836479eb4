#include "sizing/choice/size_search.hpp"

#include "parallel/observation/log.hpp"
#include "sizing/choice/predict_counts.hpp"

#include <algorithm>
#include <cmath>
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
/// Sizes on a body that would be so many times as large as the coarsest: the smallest size is half the
/// largest on the body then, and growth the preset's to this power and one.
constexpr double most_beyond = 5, power_beyond = 0.5;
// Of the logarithm of the count over that of the size: near -2 where the surface rules, flatter where small
// features do.
constexpr double first_slope = -2, steepest_slope = -3, flattest_slope = -0.2;
/// Of the logarithm of the size: four times as large or small, beyond which no slope that was measured holds.
constexpr double largest_step = 1.4;
// Far too many, and no fewer over a step that tells: what is given rules, not this size.
constexpr double infeasible = 2, flat = 0.02;  // of the logarithm of the count
// Over a shorter step counts may jump by more than they change: a flat slope says nothing then.
constexpr double least_telling_step = 0.2;
// Leaves over tetrahedra, from which on a field is not built to the end. With fewer than the least limit
// fields take so little that none is given up.
constexpr double leaves_per_tetrahedron = 0.5;
constexpr std::int64_t least_limit = 100'000;
/// Gaps of a few elements have leaves on both of their outer sides: the limit is so many times as large where
/// there are gaps. Chosen, not measured.
constexpr double leaves_around_gaps = 8;
/// Leaves that a limit may be: more than any octree has.
constexpr double most_limit = 1e15;
/// Nothing is sampled either for a field whose faces would be cut into as many parts for each of the leaves
/// of its limit.
constexpr double parts_per_leaf = 8;
/// Below this target fields that show the way have the sizes themselves: with few elements every leaf counts.
/// Above it their sizes are so many times as large, with a 64th of the leaves.
constexpr double few_tetrahedra = 300'000, usual_coarsening = 4;

/// How many tetrahedra a field predicts over what a coarser one does.
double usual_bias(double coarsening) {
  constexpr double median_of_seven_models = 0.55;  // with sizes four times as large
  return coarsening > 1 ? median_of_seven_models : 1;
}

/// Elements that are made over those that fields predict, where sizes grow faster than the preset's: next to
/// a wall they do not grow within an element. Eight models with growths of 1.3 to 1.6: 0.9 to 1.3.
double steep_bias(double growth, const GivenSizes& given) {
  constexpr double per_power = 0.45;
  if (given.growth) return 1;
  return 1 + per_power * (std::log(growth) / std::log(preset_growth) - 1);
}

double largest_extent(const FieldFactory& factory) {
  const geometry::Vec3 size = factory.sampled().body_box().size();
  return std::max({size.x, size.y, size.z});
}

}  // namespace

SizingOptions sizes_for(double body_size, const FieldFactory& factory, const GivenSizes& given) {
  const cad::Model& model = factory.model();
  SizingOptions options;
  const double coarsest = largest_extent(factory) / body_over_coarsest;
  const double beyond = std::max(1.0, body_size / coarsest);
  options.minimum = std::max(body_size / body_size_over_minimum, size_over_gap * model.sewn_gap());
  options.feature_minimum = options.minimum;
  options.surface_maximum = std::max(beyond > 1 ? coarsest : body_size, options.minimum);
  options.maximum = std::max(model.bounds().diagonal() / domain_over_maximum, options.surface_maximum);
  options.curvature_angle = preset_curvature_angle;
  options.growth = std::pow(preset_growth, 1 + power_beyond * std::log(beyond));
  return with_given(options, given);
}

bool is_steep(const SizingOptions& chosen) {
  constexpr double rounding = 1e-6;
  return chosen.growth > (1 + rounding) * preset_growth;
}

double first_size(const FieldFactory& factory) {
  return largest_extent(factory) / body_over_first;
}

std::int64_t leaves_for(double tetrahedra) {
  return std::max<std::int64_t>(least_limit,
                                std::llround(std::min(most_limit, leaves_per_tetrahedron * tetrahedra)));
}

double coarsening_for(double target_tetrahedra) {
  return target_tetrahedra < few_tetrahedra ? 1 : usual_coarsening;
}

double most_parts_for(std::int64_t leaves, double coarsening) {
  return parts_per_leaf * static_cast<double>(leaves) * coarsening * coarsening;
}

SizeSearch::SizeSearch(FieldFactory& factory, double target_tetrahedra, double coarsening,
                       const FeatureResolution& features, const GivenSizes& given)
    : _factory(factory),
      _given(given),
      _coarsening(coarsening),
      _features(features),
      _target(std::log(target_tetrahedra)),
      _most_leaves(leaves_for(target_tetrahedra *
                              (std::isfinite(factory.gaps().narrowest_gap()) ? leaves_around_gaps : 1))) {}

void SizeSearch::run(double first_size, double largest_error, int most_rounds, double coarsest_size) {
  const double extent = largest_extent(_factory);
  double finest = std::log(extent / body_over_finest);
  double coarsest = std::log(most_beyond * extent / body_over_coarsest);
  if (coarsest_size > 0) coarsest = std::clamp(std::log(coarsest_size), finest, coarsest);
  double size = std::clamp(std::log(first_size), finest, coarsest), last_size = 0, last_error = 0;
  double slope = first_slope;
  bool knows_coarsest = false;
  for (int round = 0; round < most_rounds && std::abs(_error) > largest_error; ++round) {
    const double error = judge(std::exp(size));
    if (round > 0 && last_error < far_too_many && error < far_too_many) {
      const bool is_flat =
          std::abs(error - last_error) < flat && std::abs(size - last_size) >= least_telling_step;
      if (is_flat && error > infeasible) break;
      const double measured = (error - last_error) / (size - last_size);
      const bool tells = measured <= flattest_slope || std::abs(size - last_size) >= least_telling_step;
      if (tells) slope = std::clamp(measured, steepest_slope, flattest_slope);
    }
    (error > 0 ? finest : coarsest) = size;
    knows_coarsest = knows_coarsest || error <= 0;
    if (!(finest < coarsest)) break;  // the bound was tried: nothing is left
    last_size = size, last_error = error;
    size -= std::clamp(error / slope, -largest_step, largest_step);
    // A bound that is too fine still is the answer: halves would come near it with many fields.
    if (size >= coarsest && !knows_coarsest)
      size = coarsest;
    else if (!(size > finest && size < coarsest))
      size = 0.5 * (finest + coarsest);
  }
  if (_error == far_too_many) {
    _body_size = std::exp(finest);
    _options = sizes_for(_body_size, _factory, _given);
    set_features(_options, _features);
  }
}

bool SizeSearch::is_out_of_reach() const {
  return std::abs(_error) > out_of_reach;
}

bool SizeSearch::is_infeasible() const {
  return _error > infeasible;
}

double SizeSearch::tetrahedra() const {
  return std::exp(_target + _error);
}

ChosenSizes SizeSearch::best(FieldFor purpose) {
  if (_best && !_factory.has_more_than_aimed()) {
    const PredictedCounts counts{count_triangles(_factory.sampled(), _best->field), _best->tetrahedra};
    return {_options, std::move(_best->field), counts, _features, _body_size};
  }
  ChosenSizes chosen = apply_sizes(_factory, _options, purpose);
  chosen.features = _features;
  chosen.body_size = _body_size;
  chosen.counts.tetrahedra *= steep_bias(_options.growth, _given);
  if (_best && _factory.has_more_than_aimed()) chosen.aimed = _best->tetrahedra;
  return chosen;
}

double SizeSearch::judge(double body_size) {
  SizingOptions options = sizes_for(body_size, _factory, _given);
  set_features(options, _features);
  std::optional<Trial> trial;
  std::optional<double> tetrahedra;
  if (!_factory.has_more_parts(options, most_parts_for(_most_leaves, _coarsening))) {
    if (_coarsening == 1) trial = _factory.try_sizes(options, _most_leaves);
    if (trial) tetrahedra = trial->tetrahedra;
    if (_coarsening > 1) tetrahedra = _factory.estimate_tetrahedra(options, _coarsening, _most_leaves);
  }
  if (!tetrahedra) {
    parallel::log_verbose(fmt::format("sizing: {:.4g} on the body: far too many", body_size));
    return far_too_many;
  }
  const double bias = steep_bias(options.growth, _given);
  const double count = std::max(*tetrahedra, 1.0) * usual_bias(_coarsening) * bias;
  if (trial) trial->tetrahedra *= bias;
  parallel::log_verbose(fmt::format("sizing: {:.4g} on the body: {}{:.3g} tetrahedra", body_size,
                                    _coarsening > 1 ? "about " : "", count));
  const double error = std::log(count) - _target;
  if (std::abs(error) < std::abs(_error)) {
    _error = error;
    _options = options;
    _body_size = body_size;
    _best = std::move(trial);
  }
  return error;
}

}  // namespace aeroloom::sizing
