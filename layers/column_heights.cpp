#include "layers/column_heights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

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

FittedLayers fit_layers(const Heights& heights, std::int32_t count, double limit) {
  constexpr double most_stretch = 2.5;  // chosen, not measured
  const std::int32_t step = layers_in_a_step(heights.growth), stretched = step + 1;
  std::array<double, longest_step + 2> nodes{};  // heights of the last nodes, in turn
  const auto node = [&](std::int32_t k) -> double& { return nodes[k % (stretched + 1)]; };
  FittedLayers fewest, best;
  double layer = heights.first, height = 0, least_change = std::log(most_stretch);
  for (std::int32_t k = 1; k <= count; ++k) {
    if (k > heights.constant) layer *= heights.growth;
    const double below = height, base = node(k + 1);  // of nodes k - 1 and k - stretched
    height += layer;
    node(k) = height;
    if (base >= limit) break;
    if (height <= limit) fewest = k > 1 ? FittedLayers{k, k - 1, (limit - below) / layer} : FittedLayers{1};
    if (k <= stretched || (k % step != 0 && k != count)) continue;
    const double stretch = (limit - base) / (height - base), change = std::abs(std::log(stretch));
    if (change < least_change) best = {k, k - stretched, stretch}, least_change = change;
  }
  return best.count > 0 ? best : fewest;
}

FittedLayers wanted_layers(const WallLayers& wanted, double mean_edge) {
  const Heights heights{wanted.first, wanted.growth, wanted.constant};
  const std::int32_t most = wanted.count > 0 ? wanted.count : most_layers;
  double limit = wanted.total > 0 ? wanted.total : std::numeric_limits<double>::infinity();
  if (wanted.growth > 1) {
    // The sum of the geometric series up to a last layer, for any height of that.
    const double last = std::max(isotropic_height * mean_edge, wanted.first);
    const double growing = wanted.growth / (wanted.growth - 1) * (last - wanted.first);
    limit = std::min(limit, wanted.constant * wanted.first + growing);
  }
  if (heights.total(most) <= limit) return {most};
  const FittedLayers fitted = fit_layers(heights, most, limit);
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
