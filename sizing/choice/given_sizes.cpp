#include "sizing/choice/given_sizes.hpp"

#include <algorithm>
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

}  // namespace aeroloom::sizing
