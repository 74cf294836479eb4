/// Makes axis-aligned planes exact: points on them have the same coordinate bit for bit. Internal to
/// cad/model/.
#pragma once

#include "cad/model/model_data.hpp"

#include <vector>

namespace aeroloom::cad {

/// Finds planar faces that are normal to an axis, and marks them, their edges and their vertices. The model
/// then returns the coordinate of the plane exactly. Planes within 1e-9 of the diagonal of each other share
/// one position; near zero it is zero. Edges that leave their plane by more than 1e-6 of the diagonal are not
/// marked.
void mark_exact_planes(Model::Data& data);

/// Updates the marks after edges moved; `moved` has one entry per edge. A face that its edges leave by more
/// than 1e-9 of the diagonal is no longer planar. Edges that moved within an exact plane stay exact.
void mark_planes_again(Model::Data& data, const std::vector<char>& moved);

}  // namespace aeroloom::cad
