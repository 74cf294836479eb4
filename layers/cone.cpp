#include "layers/cone.hpp"

#include <algorithm>

namespace aeroloom::layers {
namespace {

using geometry::Vec3;

/// A cone in Welzl's incremental algorithm, with two or three vectors on its border.
struct Cone {
  Vec3 axis;
  double cosine;

  bool holds(Vec3 normal) const {
    constexpr double rounding = 1e-14;
    return dot(axis, normal) >= cosine - rounding;
  }
};

Cone cone_of(Vec3 a, Vec3 b) {
  const Vec3 axis = normalized(a + b);
  return {axis, dot(axis, a)};
}

Cone cone_of(Vec3 a, Vec3 b, Vec3 c) {
  Vec3 axis = normalized(cross(b - a, c - a));
  if (dot(axis, a) < 0) axis = -axis;
  return {axis, dot(axis, a)};
}

}  // namespace

NormalCone smallest_cone(std::span<const Vec3> normals) {
  if (normals.empty()) return {};
  Cone cone{normals[0], 1};
  for (std::size_t i = 1; i < normals.size(); ++i) {
    if (cone.holds(normals[i])) continue;
    cone = {normals[i], 1};
    for (std::size_t j = 0; j < i; ++j) {
      if (cone.holds(normals[j])) continue;
      cone = cone_of(normals[i], normals[j]);
      for (std::size_t k = 0; k < j; ++k) {
        if (!cone.holds(normals[k])) cone = cone_of(normals[i], normals[j], normals[k]);
      }
    }
  }
  return {cone.axis, visibility_of(cone.axis, normals)};
}

double visibility_of(Vec3 direction, std::span<const Vec3> normals) {
  double least = 1;
  for (const Vec3 normal : normals) least = std::min(least, dot(direction, normal));
  return least;
}

}  // namespace aeroloom::layers
