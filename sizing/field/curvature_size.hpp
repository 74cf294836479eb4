/// The size that a curvature asks for.
#pragma once

#include "sizing/field/size_field.hpp"

namespace aeroloom::sizing {

/// Degrees an element may turn on the far field where curvature_angle asks for less: enough to stay round.
inline constexpr double far_field_angle = 20;

/// How far samples are apart, at most, over the size asked for there.
inline constexpr double spacing = 1.0;
/// Bisections of one facet or curve interval, at most: what is still too long then is singular.
inline constexpr int deepest_bisection = 40;

double radians_per_element(bool far_field, const SizingOptions& options);

/// Limits to the sizes that curvature asks for on the body, or on the far field, which turns slowly and has
/// no shape to keep.
struct CurvatureLimits {
  double angle;      ///< an element turns by, at most; radians
  double deviation;  ///< of triangles from the surface, at most; 0: any
};
CurvatureLimits curvature_limits(bool far_field, const SizingOptions& options);

/// The largest size on a face of the body or of the far field.
double largest_size(bool far_field, const SizingOptions& options);

/// Of an element within the limits on a curve or surface of this curvature; `largest` where it is flat.
double size_for_curvature(double curvature, const CurvatureLimits& limits, double largest,
                          const SizingOptions& options);

}  // namespace aeroloom::sizing
