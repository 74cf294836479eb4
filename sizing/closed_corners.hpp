/// Which sharp corners of faces are closed instead of being filled, and how far. What sizes and surface have
/// to agree on.
#pragma once

#include "sizing/size_field.hpp"

namespace aeroloom::sizing {

/// Corners that open by less than this many degrees are closed (surface/cusp_tips.hpp): one triangle that
/// filled them would be a needle.
inline constexpr double closed_corner = 3;

/// As far as their edges are apart by less than this. The mesh leaves the surface by half of it.
inline double closing_gap(const SizingOptions& options) {
  return 0.05 * options.minimum;
}

}  // namespace aeroloom::sizing
