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
