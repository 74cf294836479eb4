/// Parameters of facets of faces that have no single plane of parameters without cuts.
#pragma once

#include "cad/model/model.hpp"

#include <array>
#include <vector>

namespace aeroloom::cad {

/// Per triangle of Model::facets() of a face that is faceted, the parameters of its corners in the sheet that
/// the triangle lies in: a point of Facets belongs to several sheets, and has the parameters of one.
std::vector<std::array<Vec2, 3>> corner_parameters(const Model& model, FaceId faceted);

}  // namespace aeroloom::cad
