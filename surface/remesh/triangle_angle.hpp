/// A fast measure of the smallest angle of a triangle.
#pragma once

#include "geometry/vec.hpp"

#include <algorithm>

namespace aeroloom::surface {

/// Squared sine of the smallest angle, which lies between the two longest sides. 0 for a degenerate triangle.
inline double smallest_squared_sine(geometry::Vec3 a, geometry::Vec3 b, geometry::Vec3 c) {
  const geometry::Vec3 u = b - a, v = c - a, w = v - u;
  const double uu = dot(u, u), vv = dot(v, v), ww = dot(w, w);
  const geometry::Vec3 area = cross(u, v);
  const double shortest = std::min({uu, vv, ww});
  const double sides = shortest == uu ? vv * ww : shortest == vv ? uu * ww : uu * vv;
  return sides > 0 ? dot(area, area) / sides : 0;
}

}  // namespace aeroloom::surface
