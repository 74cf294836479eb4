/// The model and the sizes that a mesh was made from.
#pragma once

#include "cad/model/evaluation/point_locator.hpp"
#include "sizing/field/size_field.hpp"

namespace aeroloom::improve {

/// The origin of a mesh, as far as it is known.
struct MeshSource {
  cad::PointLocator* locator = nullptr;      ///< of the CAD model: boundary vertices may slide on it
  const sizing::SizeField* sizes = nullptr;  ///< edges keep to them (change_limits.hpp)
};

}  // namespace aeroloom::improve
