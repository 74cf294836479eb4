/// VTKHDF: one file with the whole mesh, its parts as partitions that viewers and solvers read in parallel.
///
/// Follows "VTKHDF file format" of VTK's documentation, UnstructuredGrid, version 1.0 (read since VTK 9.1).
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

/// Writes `path` (MESH.vtkhdf). /VTKHDF: a partition per part, points in double precision local to the
/// partition, cells in the order tetrahedra, pyramids, prisms; point data `global_id` (int64, also marked as
/// GlobalIds); cell data `part` and `region` (int32); field data `region_names`. All indices have 64 bits.
/// Beside it /Boundary, which viewers leave alone: the boundary faces in the order of parts, triangles
/// first, counter-clockwise seen from outside the fluid (from the front region, of faces between two, which
/// are there too): Connectivity (by global_id), Offsets (faces + 1), Types (VTK's 5 and 9), Patch (index of
/// PatchNames and PatchTypes, the latter in the words of mesh::PatchType). Collective; throws CollectiveError
/// (files) where it cannot be written. The bytes depend on the parts alone.
void write_vtkhdf(const FileMesh& mesh, const std::string& path);

/// Writes the boundary faces and those between regions to `path` as a /VTKHDF grid of their own, for viewers:
/// partitions, points and `global_id` are laid out as in write_vtkhdf, with cell data `part` and `patch`,
/// field data `patch_names` and `patch_types`. Collective; throws CollectiveError (files) where the file
/// cannot be written.
void write_vtkhdf_surface(const FileMesh& mesh, const std::string& path);

}  // namespace aeroloom::io
