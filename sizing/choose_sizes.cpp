#include "sizing/choose_sizes.hpp"

#include "parallel/log.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::sizing {
namespace {

// What the preset fixes; one length, the size on the body, follows from the target.
constexpr double preset_curvature_angle = 15;
constexpr double preset_growth = 1.3;
constexpr double size_over_gap = 10;  // the smallest size over the widest gap that was sewn
constexpr double body_size_over_minimum = 10;
// Short edges and narrow faces may ask for this part of the minimum; for the larger part where they alone
// would use up the elements asked for.
constexpr double fine_features = 0.05, coarse_features = 0.25;
constexpr double out_of_reach = 0.2;        // logarithm of the count over the target
constexpr double domain_over_maximum = 20;  // diagonal of everything
constexpr double body_over_coarsest = 5;    // largest extent of the body over the coarsest size tried on it
constexpr double body_over_finest = 5000;
constexpr double body_over_first = 60;
constexpr int most_rounds = 8;
// Of the logarithm of the count over that of the size: near -2 where the surface rules, flatter where small
// features do.
constexpr double first_slope = -2, steepest_slope = -3, flattest_slope = -0.2;
constexpr double largest_step = 1.4;  // of the logarithm of the size
// Of the target; sizes for a model that is almost the same are taken over when they come as near as the
// second.
constexpr double close_enough = 0.04, near_enough = 0.1;
// A field with more leaves than this gives several times the count: it is not built to the end.
constexpr double leaves_per_tetrahedron = 0.5;
constexpr std::int64_t least_limit = 100'000;

struct Preset {
  double maximum, gap;
  double feature_part;  // the smallest size at features over the minimum
};

SizingOptions sizes_for(double body_size, const Preset& preset) {
  SizingOptions options;
  options.minimum = std::max(body_size / body_size_over_minimum, size_over_gap * preset.gap);
  options.feature_minimum = preset.feature_part * options.minimum;
  options.surface_maximum = std::max(body_size, options.minimum);
  options.maximum = std::max(preset.maximum, options.surface_maximum);
  options.curvature_angle = preset_curvature_angle;
  options.growth = preset_growth;
  return options;
}

double largest_extent(const geometry::Box& box) {
  return std::max({box.size().x, box.size().y, box.size().z});
}

/// Searches the size on the body.
class Search {
public:
  Search(const ModelSampler& sampler, double target_tetrahedra)
      : _sampler(sampler),
        _target(std::log(target_tetrahedra)),
        _most_leaves(std::max<std::int64_t>(
            least_limit, std::llround(std::min(1e15, leaves_per_tetrahedron * target_tetrahedra)))) {}

  void run(const Preset& preset, double first_size, double largest_error) {
    _best.reset();
    _error = 1e300;
    const double extent = largest_extent(_sampler.body_box());
    double finest = std::log(extent / body_over_finest), coarsest = std::log(extent / body_over_coarsest);
    double size = std::clamp(std::log(first_size), finest, coarsest), last_size = 0, last_error = 0;
    double slope = first_slope;
    for (int round = 0; round < most_rounds && std::abs(_error) > largest_error; ++round) {
      const double error = judge(sizes_for(std::exp(size), preset));
      if (round > 0 && last_error < 1e300 && error < 1e300)
        slope = std::clamp((error - last_error) / (size - last_size), steepest_slope, flattest_slope);
      (error > 0 ? finest : coarsest) = size;
      last_size = size, last_error = error;
      size -= std::clamp(error / slope, -largest_step, largest_step);
      if (!(size > finest && size < coarsest)) size = 0.5 * (finest + coarsest);
    }
    _coarsest = sizes_for(std::exp(finest), preset);
  }

  /// The logarithm of the predicted count over the target, as near as the search came; 1e300 where every
  /// field tried was far too fine.
  double error() const { return _error; }
  ChosenSizes best() {
    if (_best) return std::move(*_best);
    SizeField field = _sampler.build_field(_coarsest);
    const PredictedCounts counts = _sampler.predict(field);
    return {_coarsest, std::move(field), counts};
  }
  double body_size() const { return (_best ? _best->options : _coarsest).surface_maximum; }

private:
  /// The error of a field; what comes nearest to the target is kept.
  double judge(const SizingOptions& options) {
    std::optional<SizeField> field = _sampler.build_field_within(options, _most_leaves);
    if (!field) {
      parallel::log_verbose(fmt::format("sizing: {:.4g} on the body: far too many", options.surface_maximum));
      return 1e300;
    }
    const PredictedCounts counts = _sampler.predict(*field);
    parallel::log_verbose(fmt::format("sizing: {:.4g} on the body: about {:.3g} tetrahedra",
                                      options.surface_maximum, counts.tetrahedra));
    const double error = std::log(std::max(counts.tetrahedra, 1.0)) - _target;
    if (std::abs(error) < std::abs(_error)) {
      _error = error;
      _best.emplace(ChosenSizes{options, std::move(*field), counts});
    }
    return error;
  }

  const ModelSampler& _sampler;
  double _target;
  std::int64_t _most_leaves;
  double _error = 1e300;
  std::optional<ChosenSizes> _best;
  SizingOptions _coarsest;  // of those tried that gave too many
};

}  // namespace

ChosenSizes choose_sizes(const ModelSampler& sampler, double target_tetrahedra,
                         const std::optional<SizingOptions>& near) {
  if (!(target_tetrahedra >= 1)) {
    throw std::invalid_argument(
        fmt::format("sizing: the target must be at least 1 tetrahedron, but it is {}", target_tetrahedra));
  }
  const cad::Model& model = sampler.model();
  Preset preset{model.bounds().diagonal() / domain_over_maximum, model.sewn_gap(), fine_features};
  Search search(sampler, target_tetrahedra);
  search.run(preset, near ? near->surface_maximum : largest_extent(sampler.body_box()) / body_over_first,
             near ? near_enough : close_enough);
  if (search.error() > out_of_reach) {
    preset.feature_part = coarse_features;
    search.run(preset, search.body_size(), close_enough);
  }
  return search.best();
}

SizingOptions choose_sizes(const parallel::Communicator& communicator, const cad::Model& model,
                           double target_tetrahedra, parallel::StageClock& clock) {
  const ModelSampler sampler(communicator, model, clock, SizingOptions{}.proximity);
  return choose_sizes(sampler, target_tetrahedra).options;
}

}  // namespace aeroloom::sizing
