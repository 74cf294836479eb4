/// How large a face is, and where.
#pragma once

#include "geometry/vec.hpp"

#include <tuple>

namespace aeroloom::cad {

struct FacePlace {
  double area = 0;
  geometry::Vec3 centre;  ///< of the area; it need not lie on the face
  geometry::Box box;

  static constexpr auto fields() { return std::tuple(&FacePlace::area, &FacePlace::centre, &FacePlace::box); }
};

}  // namespace aeroloom::cad
