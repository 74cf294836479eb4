#include "layers/column_heights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace aeroloom::layers {

std::int32_t wanted_count(const WallLayers& wanted, double mean_edge) {
  std::int32_t count = most_layers;
  if (wanted.count > 0) count = std::min(count, wanted.count);
  if (wanted.growth > 1) {
    const double steps = std::log(isotropic_height * mean_edge / wanted.first) / std::log(wanted.growth);
    const double layers = steps < 0 ? 1 : wanted.constant + std::min<double>(std::round(steps), most_layers);
    count = std::min(count, static_cast<std::int32_t>(layers));
  }
  if (wanted.total > 0) {
    count = layers_below({wanted.first, wanted.growth, wanted.constant}, count, wanted.total);
  }
  return std::max(count, 1);
}

std::int32_t layers_below(const Heights& heights, std::int32_t count, double limit) {
  std::int32_t fitting = 0;
  heights.for_each_node(count, [&](std::int32_t k, double height) {
    if (height <= limit) fitting = k;
  });
  return fitting;
}

std::int32_t layers_in_a_step(double growth) {
  // At a growth of 1.2 chosen among steps of 1 to 12 (benchmarks/results/layers.md, "Where columns end").
  if (growth <= 1) return longest_step;
  return static_cast<std::int32_t>(
      std::clamp<long>(std::lround(std::log(2) / std::log(growth)), 1, longest_step));
}

namespace {

/// The growth of the last layers at most, where columns are lower than they should be: those below the
/// tetrahedra are thin there otherwise. At 1.2 numbers in steps of a factor of two need 1 to 1.5; at other
/// growths tests say that 1.25 times that is enough. Solvers ran on such ends at 1.2 alone.
double steepest_end(double growth) {
  return std::max(1.5, 1.25 * growth);
}

/// The ratio x between `low` and `high` by which the sum of layers[i] x^(i+1) is `height`. By Newton's
/// method.
double stretch_to(std::span<const double> layers, double height, double low, double high) {
  constexpr int most_steps = 60;
  double x = std::clamp(1.0, low, high);
  for (int step = 0; step < most_steps; ++step) {
    double sum = 0, slope = 0, power = 1;
    for (std::size_t i = 0; i < layers.size(); ++i) {
      slope += static_cast<double>(i + 1) * layers[i] * power;
      power *= x;
      sum += layers[i] * power;
    }
    const double newton = x - (sum - height) / slope;
    if (std::abs(newton - x) <= 1e-15 * x) break;
    (sum < height ? low : high) = x;
    x = newton > low && newton < high ? newton : 0.5 * (low + high);
  }
  return x;
}

double stretched_sum(std::span<const double> layers, double x) {
  double sum = 0;
  for (std::size_t i = layers.size(); i-- > 0;) sum = (sum + layers[i]) * x;
  return sum;
}

}  // namespace

FittedLayers fit_layers(const Heights& heights, std::int32_t count, double limit, double last) {
  const std::int32_t step = layers_in_a_step(heights.growth), stretched = step + 1;
  const double low = 1 / heights.growth, high = steepest_end(heights.growth) / heights.growth;
  std::array<double, longest_step + 1> layers{};  // the last ones, ascending
  const std::span<double> ends(layers.data(), static_cast<std::size_t>(stretched));
  FittedLayers fewest, best;
  double layer = heights.first, height = 0, base = 0, least_off = std::numeric_limits<double>::infinity();
  for (std::int32_t k = 1; k <= count; ++k) {
    if (k > heights.constant) layer *= heights.growth;
    const double below = height;
    height += layer;
    if (k > stretched) base += ends[0];
    std::shift_left(ends.begin(), ends.end(), 1);
    ends.back() = layer;
    if (base >= limit) break;
    if (height <= limit) fewest = k > 1 ? FittedLayers{k, k - 1, (limit - below) / layer} : FittedLayers{1};
    if (k <= stretched || (k % step != 0 && k != count)) continue;
    const double rest = limit - base;
    if (rest < stretched_sum(ends, low) || rest > stretched_sum(ends, high)) continue;
    const FittedLayers fitted{k, k - stretched, stretch_to(ends, rest, low, high)};
    const double end = layer * std::pow(fitted.stretch, stretched), off = std::abs(std::log(end / last));
    if (off < least_off) best = fitted, least_off = off;
  }
  return best.count > 0 ? best : fewest;
}

FittedLayers wanted_layers(const WallLayers& wanted, double mean_edge) {
  const Heights heights{wanted.first, wanted.growth, wanted.constant};
  const std::int32_t most = wanted.count > 0 ? wanted.count : most_layers;
  double limit = wanted.total > 0 ? wanted.total : std::numeric_limits<double>::infinity(),
         last = wanted.first;
  if (wanted.growth > 1) {
    // The sum of the geometric series up to a last layer, for any height of that.
    const double below = wanted.constant * wanted.first, rise = wanted.growth / (wanted.growth - 1);
    const double isotropic = std::max(isotropic_height * mean_edge, wanted.first);
    limit = std::min(limit, below + rise * (isotropic - wanted.first));
    last = wanted.first + std::max(0.0, limit - below) / rise;
  }
  if (heights.total(most) <= limit) return {most};
  const FittedLayers fitted = fit_layers(heights, most, limit, last);
  return fitted.count > 0 ? fitted : FittedLayers{1};
}

double growth_of_total(const Heights& steepest, std::int32_t count, double total) {
  if (steepest.total(count) <= total) return steepest.growth;
  constexpr int halvings = 40;
  Heights slower = steepest;
  double low = 1, high = steepest.growth;
  for (int i = 0; i < halvings; ++i) {
    slower.growth = 0.5 * (low + high);
    (slower.total(count) <= total ? low : high) = slower.growth;
  }
  return low;
}

namespace {

/// Leaves room for the layers on the opposite wall.
constexpr double most_of_gap = 0.4;
/// Where a gap is about as narrow as an edge. Less would leave thin layers below large tetrahedra.
constexpr double least_of_gap = 0.25;

}  // namespace

double ample_gap(double total, double mean_edge) {
  return std::max(total / most_of_gap, 2 * total + mean_edge);
}

double room_in_gap(double gap, double mean_edge, double visibility) {
  const double least = std::min(most_of_gap, least_of_gap / visibility);
  return std::clamp(0.5 * (gap - mean_edge), least * gap, most_of_gap * gap);
}

}  // namespace aeroloom::layers
