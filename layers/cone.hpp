/// The smallest cone around unit vectors.
#pragma once

#include "geometry/vec.hpp"

#include <span>

namespace aeroloom::layers {

/// The axis of the smallest cone that holds all normals, of unit length: of all directions that which keeps
/// most away from the planes of the triangles, the most normal one (Aubry and Loehner, On the most normal
/// normal, Commun. Numer. Meth. Eng. 24, 2008, doi:10.1002/cnm.1056). `visibility` is its smallest dot
/// product with a normal: where that is not positive no direction sees all triangles.
struct NormalCone {
  geometry::Vec3 axis;
  double visibility = -1;
};
/// A function of the normals and their order; of none, the zero axis.
NormalCone smallest_cone(std::span<const geometry::Vec3> normals);

/// The smallest dot product of a direction with the normals.
double visibility_of(geometry::Vec3 direction, std::span<const geometry::Vec3> normals);

}  // namespace aeroloom::layers
