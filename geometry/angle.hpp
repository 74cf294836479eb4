/// Degrees, radians, angles.
#pragma once

#include "geometry/vec.hpp"

#include <cmath>
#include <numbers>

namespace aeroloom::geometry {

inline constexpr double degree = std::numbers::pi / 180;              ///< in radians
inline constexpr double degrees_per_radian = 180 / std::numbers::pi;  ///< rounding differs from 1 / degree

/// The angle between two vectors, 0 to pi radians. Accurate for small angles too.
inline double angle_between(Vec3 a, Vec3 b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

}  // namespace aeroloom::geometry
