/// The smallest cone around a set of unit vectors.
#pragma once

#include "geometry/vec.hpp"

#include <span>

namespace aeroloom::layers {

/// The "most normal normal" of the triangles around a vertex: the unit axis of the smallest cone that
/// contains all their normals (Aubry and Loehner, On the most normal normal, Commun. Numer. Meth. Eng. 24,
/// 2008, doi:10.1002/cnm.1056). `visibility` is its smallest dot product with a normal. If it is not
/// positive, no direction sees all triangles.
struct NormalCone {
  geometry::Vec3 axis;
  double visibility = -1;
};
/// Depends only on the normals and their order. Without normals the axis is zero.
NormalCone smallest_cone(std::span<const geometry::Vec3> normals);

/// The smallest dot product of a direction with the normals.
double visibility_of(geometry::Vec3 direction, std::span<const geometry::Vec3> normals);

}  // namespace aeroloom::layers
