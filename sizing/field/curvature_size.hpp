/// The size that a curvature asks for.
#pragma once

#include "sizing/field/size_field.hpp"

namespace aeroloom::sizing {

/// Degrees that an element may turn on the far field, if curvature_angle is smaller. It keeps the far field
/// round.
inline constexpr double far_field_angle = 20;

/// The largest distance of two samples, over the size asked for there.
inline constexpr double spacing = 1.0;
/// The most bisections of one facet or curve interval. What is still too long then is singular.
inline constexpr int deepest_bisection = 40;

double radians_per_element(bool far_field, const SizingOptions& options);

/// How far elements may deviate from a curved surface. The far field has larger limits, since its shape does
/// not matter.
struct CurvatureLimits {
  double angle;      ///< largest turn of an element, radians
  double deviation;  ///< largest distance of triangles from the surface; 0: any
};
CurvatureLimits curvature_limits(bool far_field, const SizingOptions& options);

/// The largest size on a face of the body or of the far field.
double largest_size(bool far_field, const SizingOptions& options);

/// The size of an element within the limits, on a curve or surface of this curvature. It is `largest` where
/// the surface is flat.
double size_for_curvature(double curvature, const CurvatureLimits& limits, double largest,
                          const SizingOptions& options);

}  // namespace aeroloom::sizing
