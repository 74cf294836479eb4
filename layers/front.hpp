/// The front, and columns that shrink until it is free of intersections.
#pragma once

#include "layers/column_limits.hpp"

namespace aeroloom::layers {

/// The columns of all pieces of this rank.
Columns make_columns(const WallShare& wall, const Directions& directions, const ColumnLimits& limits);

/// The wall mesh with its vertices moved to the ends of their columns.
mesh::DistributedMesh make_front(const mesh::DistributedMesh& wall, const Columns& columns);

/// Where triangles of the front meet, counts of their columns fall by a third, neighbours follow, cells are
/// made good again, until no triangles meet. After some rounds columns whose triangles still meet are
/// emptied. What a wall has of intersections itself stays. Writes rounds and counts to the report.
/// Collective.
void shrink_to_clear(const parallel::Communicator& communicator, const WallShare& wall,
                     const Directions& directions, ColumnLimits& limits, LayerReport& report,
                     parallel::StageClock& clock);

}  // namespace aeroloom::layers
