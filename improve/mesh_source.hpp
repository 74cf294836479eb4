/// The CAD model and the size field that a mesh was made from.
#pragma once

#include "cad/model/evaluation/point_locator.hpp"
#include "sizing/field/size_field.hpp"

namespace aeroloom::improve {

/// Either may be unknown: null.
struct MeshSource {
  cad::PointLocator* locator = nullptr;      ///< on the CAD model, for sliding boundary vertices
  const sizing::SizeField* sizes = nullptr;  ///< limits edge lengths (limits/change_limits.hpp)
};

}  // namespace aeroloom::improve
