/// Reads VTKHDF files of any origin.
#pragma once

#include "io/raw_mesh.hpp"

namespace aeroloom::io {

/// Reads an UnstructuredGrid of any number of partitions, chunked or not, compressed or not. Every rank reads
/// its range of points, cells and faces.
///
/// The ids of points are the point data `global_id`, or the data marked as GlobalIds, or GlobalPointIds.
/// Without ids a file of one partition uses its own numbers. Several partitions without ids are an error: no
/// points are matched by coordinates. Regions are the cell data `region`, with names from the field data
/// `region_names`, or region_VALUE. Without it there is one region, `fluid`. Faces come from the group
/// /Boundary if it has Patch and PatchNames (vtkhdf_writer.hpp). Otherwise they are the triangles and
/// quadrilaterals among the cells, if there is cell data `patch`. Names of patches are in the field data
/// `patch_names`, or are patch_VALUE; conditions are in `patch_types`, or are walls. Points, lines, and cells
/// that `vtkGhostType` marks as duplicates are left out.
///
/// Collective. Throws CollectiveError: (files) where the file cannot be opened; (input) for all else: no
/// VTKHDF file, other types of data, several time steps, other shapes of cells, arrays that contradict each
/// other.
RawMesh read_vtkhdf(const SharedPath& file);

}  // namespace aeroloom::io
