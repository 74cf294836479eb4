/// Meshes for ParaView: .pvtu with .vtu parts, .pvtp with .vtp parts; binary appended. Coordinates and global
/// numbers have 64 bits, the points of a cell, which are numbers within a part, 32.
#pragma once

#include "mesh/distributed_mesh.hpp"
#include "parallel/communicator.hpp"

#include <array>
#include <string>
#include <vector>

namespace aeroloom::io {

/// Of the arrays in a file, in blocks.
enum class Compression { none, lz4, zlib };

/// Writes DIRECTORY/NAME.pvtu and its parts in DIRECTORY/NAME/. Tetrahedra only. Cell arrays `piece`,
/// `region`, `mean_ratio`, `min_dihedral`; field array `region_names`; point array `global_id`. One part is
/// in VTK's form at a time on each rank. The files are the same bytes for any number of ranks. Collective;
/// throws on all ranks when a file cannot be written.
void write_volume(const parallel::Communicator& communicator, const mesh::DistributedMesh& mesh,
                  const mesh::Numbering& numbering, const std::string& directory, const std::string& name,
                  Compression compression = Compression::none);

/// Writes DIRECTORY/NAME.pvtp and its parts in DIRECTORY/NAME/. Cell arrays `face` and `patch` (ids),
/// `quality`; field arrays `face_names` and `patch_names`; point array `global_id`. Collective, as
/// write_volume.
void write_surface(const parallel::Communicator& communicator, const mesh::DistributedMesh& surface,
                   const mesh::Numbering& numbering, const std::string& directory, const std::string& name,
                   Compression compression = Compression::none);

/// Writes single triangles, e.g. offenders of a failure, to one .vtp file. Not collective.
void write_triangles(const std::vector<geometry::Vec3>& points,
                     const std::vector<std::array<mesh::LocalIndex, 3>>& triangles, const std::string& file);

}  // namespace aeroloom::io
