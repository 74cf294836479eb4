/// Axis-aligned planes that are exact: points on them get one coordinate bit for bit. Seen by this folder
/// only.
#pragma once

#include "cad/model/model_data.hpp"

#include <vector>

namespace aeroloom::cad {

/// Finds the planar faces whose normal is an axis and marks them, their edges and their vertices, so that the
/// model's evaluations return the plane's coordinate exactly. Planes closer to each other than 1e-9 of the
/// diagonal share one position; one that close to the origin is at zero. Edges that leave the plane by more
/// than 1e-6 of the diagonal stay as they are.
void mark_exact_planes(Model::Data& data);

/// After edges `moved` (one entry per edge): faces that they leave by more than 1e-9 of the diagonal are
/// planar no more; those that moved within an exact plane are as exact as before.
void mark_planes_again(Model::Data& data, const std::vector<char>& moved);

}  // namespace aeroloom::cad
