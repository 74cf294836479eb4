#include "sizing/model_sampler.hpp"

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
constexpr double largest_step = 1.4;   // of the logarithm of the size
constexpr double close_enough = 0.04;  // of the target

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

struct Choice {
  double body_size;
  double error;  // logarithm of the predicted count over the target
};

Choice search(const ModelSampler& sampler, double target_tetrahedra, const Preset& preset) {
  const double extent = largest_extent(sampler.body_box());
  const double target = std::log(target_tetrahedra);
  double finest = std::log(extent / body_over_finest), coarsest = std::log(extent / body_over_coarsest);
  double size = std::log(extent / body_over_first), last_size = 0, last_error = 0;
  Choice best{std::exp(size), 1e300};
  double slope = first_slope;
  for (int round = 0; round < most_rounds && std::abs(best.error) > close_enough; ++round) {
    const SizeField field = sampler.build_field(sizes_for(std::exp(size), preset));
    const double error = std::log(std::max(sampler.predict(field).tetrahedra, 1.0)) - target;
    if (std::abs(error) < std::abs(best.error)) best = {std::exp(size), error};
    if (round > 0)
      slope = std::clamp((error - last_error) / (size - last_size), steepest_slope, flattest_slope);
    (error > 0 ? finest : coarsest) = size;
    last_size = size, last_error = error;
    size -= std::clamp(error / slope, -largest_step, largest_step);
    if (!(size > finest && size < coarsest)) size = 0.5 * (finest + coarsest);
  }
  return best;
}

}  // namespace

SizingOptions choose_sizes(const parallel::Communicator& communicator, const cad::Model& model,
                           double target_tetrahedra, parallel::StageClock& clock) {
  if (!(target_tetrahedra >= 1)) {
    throw std::invalid_argument(
        fmt::format("sizing: the target must be at least 1 tetrahedron, but it is {}", target_tetrahedra));
  }
  const ModelSampler sampler(communicator, model, clock, SizingOptions{}.proximity);
  Preset preset{model.bounds().diagonal() / domain_over_maximum, model.sewn_gap(), fine_features};
  Choice choice = search(sampler, target_tetrahedra, preset);
  if (choice.error > out_of_reach) {
    preset.feature_part = coarse_features;
    choice = search(sampler, target_tetrahedra, preset);
  }
  return sizes_for(choice.body_size, preset);
}

}  // namespace aeroloom::sizing
