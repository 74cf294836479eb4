#include "sizing/choice/given_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::sizing {

SizingOptions with_given(const SizingOptions& options, const GivenSizes& given) {
  if (given.minimum && given.maximum && *given.minimum > *given.maximum) {
    throw std::invalid_argument(fmt::format("sizing: the minimum ({:.6g}) exceeds the maximum ({:.6g})",
                                            *given.minimum, *given.maximum));
  }
  SizingOptions sizes = options;
  sizes.chordal_deviation = given.chordal_deviation.value_or(sizes.chordal_deviation);
  sizes.curvature_angle = given.curvature_angle.value_or(sizes.curvature_angle);
  sizes.proximity = given.proximity.value_or(sizes.proximity);
  if (given.gap_proximity) sizes.gap_proximity = *given.gap_proximity;
  sizes.growth = given.growth.value_or(sizes.growth);
  sizes.surface_maximum = given.surface_maximum.value_or(sizes.surface_maximum);
  sizes.maximum = given.maximum.value_or(std::max(sizes.maximum, given.minimum.value_or(0)));
  const double largest =
      sizes.surface_maximum > 0 ? std::min(sizes.maximum, sizes.surface_maximum) : sizes.maximum;
  if (given.minimum) {
    sizes.minimum = *given.minimum;
    sizes.feature_minimum = sizes.narrow_minimum = sizes.gap_minimum = 0;
    if (!given.surface_maximum && sizes.surface_maximum > 0)
      sizes.surface_maximum = std::max(sizes.surface_maximum, sizes.minimum);
  } else if (sizes.minimum > largest) {
    sizes.minimum = largest;
    sizes.feature_minimum = std::min(sizes.feature_minimum, largest);
  }
  if (given.feature_minimum) sizes.feature_minimum = *given.feature_minimum, sizes.narrow_minimum = 0;
  return sizes;
}

SizingOptions at_scale(const SizingOptions& options, double factor) {
  SizingOptions sizes = options;
  for (double* size : {&sizes.minimum, &sizes.maximum, &sizes.surface_maximum, &sizes.feature_minimum,
                       &sizes.narrow_minimum, &sizes.gap_minimum, &sizes.curvature_angle})
    *size *= factor;
  sizes.feature_aspect = std::max(1.0, sizes.feature_aspect * factor);
  sizes.chordal_deviation *= factor * factor;
  sizes.growth = std::pow(sizes.growth, factor);
  if (sizes.proximity > 0) sizes.proximity /= factor;
  if (sizes.gap_proximity > 0) sizes.gap_proximity /= factor;
  if (options.proximity < 0 && options.gap_proximity < 0)
    sizes.gap_proximity = elements_across_gaps(options) / factor;
  return sizes;
}

PredictedCounts at_scale(const PredictedCounts& counts, double factor) {
  return {counts.triangles / (factor * factor), counts.tetrahedra / (factor * factor * factor)};
}

}  // namespace aeroloom::sizing
