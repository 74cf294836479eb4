/// Widths of faces.
#pragma once

#include "cad/model/model.hpp"

namespace aeroloom::cad {

/// Length of an edge, to a few percent.
double rough_length(const Model& model, EdgeId edge);

/// Twice the area over the perimeter, which is about the width of a strip. Seams do not count. If only seams
/// bound the face, the root of its area.
double mean_width(const Model& model, FaceId face);

}  // namespace aeroloom::cad
