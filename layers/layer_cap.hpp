/// The layer cap, which is the outer surface of the layers, and the removal of its intersections.
#pragma once

#include "layers/column_limits.hpp"

#include <vector>

namespace aeroloom::layers {

/// The columns of all pieces of this rank.
Columns make_columns(const LocalWall& wall, const Fans& fans, const Directions& directions,
                     const ColumnLimits& limits);

/// The wall mesh with its vertices moved to the ends of their columns, as CapLayout has it.
mesh::DistributedMesh make_cap(const mesh::DistributedMesh& wall, const Columns& columns);

/// What is done to a cap before it is tested.
struct CapChanges {
  const PlaneRemesher& remesh_planes;  ///< not empty if layers end on planes
  const OpenedWall* opened = nullptr;  ///< of a wall that was opened: its cap is glued
};

/// Shrinks columns until the cap has no intersections.
class CapClearing {
public:
  /// Arguments must outlive the object. Collective.
  CapClearing(const LocalWall& wall, const Fans& fans, const Directions& directions,
              const CapChanges& changes);

  /// Repeats until no triangles of the cap intersect, no part is enclosed, and all planes can be meshed
  /// again. In each round the counts of the columns concerned fall by a third. After ten rounds they fall to
  /// zero. Each round also lowers neighbours and removes bad cells. Intersections of the wall itself remain.
  /// Adds numbers of rounds and intersections to the report, and returns the cap. Collective.
  mesh::DistributedMesh run(ColumnLimits& limits, LayerReport& report) const;

private:
  class LoweredCounts;
  /// Lowers the columns of these vertices. If none of them has layers, lowers all columns on planes.
  void lower_on_planes(const std::vector<mesh::SharedVertexKey>& at_fault, LoweredCounts& lower) const;
  /// Lowers the columns whose layers enclose a part of the boundary.
  void lower_around_parts(const Columns& columns, LoweredCounts& lower, LayerReport& report) const;
  /// Lowers the columns that make the cap invalid. Returns whether there were none.
  bool is_clear(const Columns& columns, mesh::DistributedMesh& cap, LoweredCounts& lower,
                LayerReport& report) const;

  const LocalWall& _wall;
  const Fans& _fans;
  const Directions& _directions;
  const PlaneRemesher& _remesh_planes;
  const OpenedWall* _opened;
  std::vector<mesh::PieceId> _kept;  ///< wall pieces off the planes, in the order of the cap
};

}  // namespace aeroloom::layers
