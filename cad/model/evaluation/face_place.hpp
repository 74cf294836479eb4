/// Size and position of a face.
#pragma once

#include "geometry/vec.hpp"

#include <tuple>

namespace aeroloom::cad {

struct FacePlace {
  double area = 0;
  geometry::Vec3 centre;  ///< centroid; need not lie on the face
  geometry::Box box;

  static constexpr auto fields() { return std::tuple(&FacePlace::area, &FacePlace::centre, &FacePlace::box); }
};

}  // namespace aeroloom::cad
