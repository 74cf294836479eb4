/// The surface parameters of a point beside a facet.
#pragma once

#include "sizing/features/triangle_tree.hpp"

#include <array>

namespace aeroloom::sizing {

using Parameters = std::array<geometry::Vec2, 3>;

/// The parameters of a point in the plane of a facet, or above it along the normal, from those of the
/// corners.
inline geometry::Vec2 parameters_at(const Triangle& corners, const Parameters& parameters,
                                    geometry::Vec3 point) {
  const geometry::Vec3 p = corners[0], ab = corners[1] - p, ac = corners[2] - p, normal = cross(ab, ac);
  const double square = dot(normal, normal);
  const double v = dot(cross(point - p, ac), normal) / square, w = dot(cross(ab, point - p), normal) / square;
  return (1 - v - w) * parameters[0] + v * parameters[1] + w * parameters[2];
}

}  // namespace aeroloom::sizing
