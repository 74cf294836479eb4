/// The cap, and columns that shrink until it is free of intersections.
#pragma once

#include "layers/column_limits.hpp"

#include <vector>

namespace aeroloom::layers {

/// The columns of all pieces of this rank.
Columns make_columns(const LocalWall& wall, const Directions& directions, const ColumnLimits& limits);

/// The wall mesh with its vertices moved to the ends of their columns.
mesh::DistributedMesh make_cap(const mesh::DistributedMesh& wall, const Columns& columns);

/// Makes fronts free of intersections.
class CapClearing {
public:
  /// Refers to all of them. Where layers end on planes `remesh_planes` is not empty. Collective.
  CapClearing(const LocalWall& wall, const Directions& directions, const PlaneRemesher& remesh_planes);

  /// Where triangles of the cap meet or close around a part, or planes cannot be meshed again, counts of
  /// their columns fall by a third, neighbours follow, cells are made good again, until no triangles meet.
  /// After some rounds columns whose triangles still meet are emptied. What a wall has of intersections
  /// itself stays. Writes rounds and counts to the report, and returns the cap. Collective.
  mesh::DistributedMesh run(ColumnLimits& limits, LayerReport& report) const;

private:
  class LoweredCounts;
  /// Lowers the columns of vertices at fault; where none of them has layers, all on planes.
  void lower_on_planes(const std::vector<mesh::SharedVertexKey>& at_fault, LoweredCounts& lower) const;
  /// Lowers the columns that have closed around a part of the boundary.
  void lower_around_parts(const mesh::DistributedMesh& cap, LoweredCounts& lower, LayerReport& report) const;
  /// Lowers what is in the way of a cap; returns whether that is nothing.
  bool is_clear(mesh::DistributedMesh& cap, LoweredCounts& lower, LayerReport& report) const;

  const LocalWall& _wall;
  const Directions& _directions;
  const PlaneRemesher& _remesh_planes;
  std::vector<mesh::PieceId> _kept;  ///< pieces of the wall that are not of planes, as the cap counts them
};

}  // namespace aeroloom::layers
