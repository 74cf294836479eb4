#include "layers/column_heights.hpp"

#include <algorithm>
#include <cmath>

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
    std::int32_t fitting = 0;
    const Heights heights{wanted.first, wanted.growth, wanted.constant};
    heights.for_each_node(count, [&](std::int32_t k, double height) {
      if (height <= wanted.total) fitting = k;
    });
    count = fitting;
  }
  return std::max(count, 1);
}

Compressed compress(const Heights& heights, std::int32_t count, double limit) {
  if (heights.total(count) <= limit) return {heights.growth, count};
  Heights slower = heights;
  slower.growth = 1;
  if (slower.total(count) > limit) {
    std::int32_t fitting = 0;
    slower.for_each_node(count, [&](std::int32_t k, double height) {
      if (height <= limit) fitting = k;
    });
    return {1, fitting};
  }
  constexpr int halvings = 40;
  double low = 1, high = heights.growth;
  for (int i = 0; i < halvings; ++i) {
    slower.growth = 0.5 * (low + high);
    (slower.total(count) <= limit ? low : high) = slower.growth;
  }
  return {low, count};
}

namespace {

/// Leaves room for the layers on the opposite wall.
constexpr double most_of_gap = 0.4;

}  // namespace

double ample_gap(double total, double mean_edge) {
  return std::max(total / most_of_gap, 2 * total + mean_edge);
}

double room_in_gap(double gap, double mean_edge, double all_first) {
  const double most = most_of_gap * gap, beside_edge = 0.5 * (gap - mean_edge);
  return std::max(std::min(most, beside_edge), std::min(all_first, most));
}

}  // namespace aeroloom::layers
