#include "sizing/field/curvature_size.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aeroloom::sizing {
namespace {

/// A triangle with edges l leaves a surface of curvature k by k R^2 / 2 in its middle, R = l / sqrt(3); edges
/// may be 1.4 times as long as the size.
double size_for_deviation(double curvature, double deviation, const SizingOptions& options) {
  return std::max(std::sqrt(3 * deviation / curvature), smallest_feature_size(options));
}

}  // namespace

double radians_per_element(bool far_field, const SizingOptions& options) {
  const double degrees =
      far_field ? std::max(options.curvature_angle, far_field_angle) : options.curvature_angle;
  return degrees * std::numbers::pi / 180;
}

double largest_size(bool far_field, const SizingOptions& options) {
  return far_field || options.surface_maximum == 0 ? options.maximum
                                                   : std::min(options.maximum, options.surface_maximum);
}

CurvatureLimits curvature_limits(bool far_field, const SizingOptions& options) {
  return {radians_per_element(far_field, options), far_field ? 0 : options.chordal_deviation};
}

double size_for_curvature(double curvature, const CurvatureLimits& limits, double largest,
                          const SizingOptions& options) {
  const double k = std::abs(curvature);
  const double size = k * largest > limits.angle ? std::max(limits.angle / k, options.minimum) : largest;
  return limits.deviation > 0 && k > 0 ? std::min(size, size_for_deviation(k, limits.deviation, options))
                                       : size;
}

}  // namespace aeroloom::sizing
