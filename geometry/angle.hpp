/// Degrees and radians.
#pragma once

#include <numbers>

namespace aeroloom::geometry {

inline constexpr double degree = std::numbers::pi / 180;              ///< in radians
inline constexpr double degrees_per_radian = 180 / std::numbers::pi;  ///< rounded on its own, not 1 / degree

}  // namespace aeroloom::geometry
