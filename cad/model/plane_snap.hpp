/// Axis-aligned planes that are exact: points on them get one coordinate bit for bit. Seen by this folder
/// only.
#pragma once

#include "cad/model/model_data.hpp"

namespace aeroloom::cad {

/// Finds the planar faces whose normal is an axis and marks them, their edges and their vertices, so that the
/// model's evaluations return the plane's coordinate exactly. Planes closer to each other than 1e-9 of the
/// diagonal share one position; one that close to the origin is at zero. Edges that leave the plane by more
/// than 1e-6 of the diagonal stay as they are.
void mark_exact_planes(Model::Data& data);

}  // namespace aeroloom::cad
