/// How wide faces are.
#pragma once

#include "cad/model/model.hpp"

namespace aeroloom::cad {

/// Length of an edge to a few percent.
double rough_length(const Model& model, EdgeId edge);

/// Twice the area over the perimeter: about the width of a strip, whatever its length. Seams do not count;
/// the root of the area where there is nothing else.
double mean_width(const Model& model, FaceId face);

}  // namespace aeroloom::cad
