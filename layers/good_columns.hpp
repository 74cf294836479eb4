/// Shrinks columns until all cells between wall and layer cap are good.
#pragma once

#include "layers/column_limits.hpp"

namespace aeroloom::layers {

/// Bounds column heights by fitting_height(), then lowers neighbours, and repeats until all cells are good.
/// Checks only triangles whose columns changed since the last call. Returns the number of rounds, equal on
/// all ranks. Collective.
int shrink_to_good(const LocalWall& wall, const Fans& fans, const Directions& directions,
                   ColumnLimits& limits);

}  // namespace aeroloom::layers
