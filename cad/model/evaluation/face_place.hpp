/// Size and position of a face.
#pragma once

#include "geometry/vec.hpp"

namespace aeroloom::cad {

struct FacePlace {
  double area = 0;
  geometry::Vec3 centre;  ///< centroid; need not lie on the face
  geometry::Box box;
};

}  // namespace aeroloom::cad
