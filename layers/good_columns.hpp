/// Columns shrink until all their cells are good.
#pragma once

#include "layers/column_limits.hpp"

namespace aeroloom::layers {

/// Where a cell over a wall triangle is not good, its columns end below that, and neighbours follow, until
/// all are. Looks only at triangles whose columns changed since the last call. Returns the rounds it took,
/// the same on every rank. Collective.
int shrink_to_good(const LocalWall& wall, const Directions& directions, ColumnLimits& limits);

}  // namespace aeroloom::layers
