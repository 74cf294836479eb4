/// Parameters of faceted faces, triangle by triangle.
#pragma once

#include "cad/model/model.hpp"

#include <array>
#include <vector>

namespace aeroloom::cad {

/// Per triangle of Model::facets(), the parameters of its corners in the sheet of the triangle. A point may
/// belong to several sheets, but Facets gives its parameters in one only. The face must be faceted.
std::vector<std::array<Vec2, 3>> corner_parameters(const Model& model, FaceId faceted);

}  // namespace aeroloom::cad
