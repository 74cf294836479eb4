/// Writes VTKHDF: one file with the whole mesh. Its parts are partitions, which programs can read in
/// parallel.
///
/// Follows "VTKHDF file format" in VTK's documentation, UnstructuredGrid, version 1.0 (read since VTK 9.1).
#pragma once

#include "io/file_mesh.hpp"

#include <string>

namespace aeroloom::io {

/// Writes `path` (MESH.vtkhdf). The group /VTKHDF has a partition for each part, with its own points in
/// double precision, and tetrahedra, pyramids, prisms in this order. Point data: `global_id` (int64, marked
/// as GlobalIds). Cell data: `part` and `region` (int32). Field data: `region_names`. All indices have 64
/// bits. The group /Boundary, which viewers ignore, has the boundary faces and the faces between regions, by
/// part with triangles first. They are counter-clockwise seen from outside the fluid, or from the front one
/// of two regions. Arrays: Connectivity (global_id), Offsets (faces + 1), Types (VTK's 5 and 9), Patch (index
/// in PatchNames and in PatchTypes, the names of mesh::PatchType). The bytes depend on the parts alone.
/// Collective; throws CollectiveError (files) where the file cannot be written.
void write_vtkhdf(const FileMesh& mesh, const std::string& path);

/// Writes the boundary faces and the faces between regions to `path` as a grid of their own, for viewers. The
/// file is as that of write_vtkhdf, but has cell data `part` and `patch`, and field data `patch_names` and
/// `patch_types`. Collective; throws CollectiveError (files) where the file cannot be written.
void write_vtkhdf_surface(const FileMesh& mesh, const std::string& path);

}  // namespace aeroloom::io
