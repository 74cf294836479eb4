/// Reads VTKHDF files of any origin.
#pragma once

#include "io/raw_mesh.hpp"

namespace aeroloom::io {

/// Reads an UnstructuredGrid of any number of partitions, contiguous or chunked, compressed or not; each rank
/// its share of points, cells and faces.
///
/// Points are known by the point data `global_id`, that which is marked as GlobalIds, or GlobalPointIds; in
/// this order. Without any a file of one partition has its own numbers; one of several is an error, for
/// nothing says which points of two partitions are one (never matched by coordinates).
/// Regions are the cell data `region`, called as the field data `region_names` says or region_VALUE; without
/// it there is one, `fluid`. Faces come from the group /Boundary where it has Patch and
/// PatchNames (vtkhdf_writer.hpp); without it, from
/// triangles and quadrilaterals among the cells if there is cell data `patch` (names: field data
/// `patch_names`, or patch_VALUE; conditions: `patch_types`, or wall). Cells that `vtkGhostType` marks as
/// duplicates, points and lines are left out.
///
/// Throws CollectiveError: files where it cannot be opened, input for anything else: no VTKHDF file, another
/// type of data, several time steps, cells of other shapes, arrays that contradict each other. Collective.
RawMesh read_vtkhdf(const SharedPath& file);

}  // namespace aeroloom::io
