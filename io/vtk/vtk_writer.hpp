/// Meshes for ParaView: .pvtu with .vtu parts, .pvtp with .vtp parts; binary appended. Coordinates and global
/// numbers have 64 bits, the points of a cell, which are numbers within a part, 32.
#pragma once

#include "io/file_mesh.hpp"
#include "mesh/data/distributed_mesh.hpp"
#include "parallel/communication/communicator.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace aeroloom::io {

/// Of the arrays in a file, in blocks.
enum class Compression { none, lz4, zlib };

/// Of a mesh with so many. Viewers see faces between parts as boundary: meshes of common size are one or two
/// parts. Larger ones are some fifty, for as many ranks to write them, and up to five hundred: no more files,
/// however large the mesh.
constexpr mesh::GlobalIndex cells_per_vtk_file(mesh::GlobalIndex cells) {
  constexpr mesh::GlobalIndex most = 1'000'000, least = 200'000, largest_whole = 2'000'000, most_files = 500;
  const mesh::GlobalIndex of_large = most * largest_whole / std::max<mesh::GlobalIndex>(cells, 1);
  return std::max(std::clamp(of_large, least, most), cells / most_files);
}

/// Writes DIRECTORY/NAME.pvtu and its parts in DIRECTORY/NAME/, each of consecutive parts of the mesh until
/// they have cells_per_vtk_file. Cells by part, then shape, then region. Cell arrays `piece`, `region`,
/// `mean_ratio` and `min_dihedral` (io/vtk/cell_quality.hpp), with boundary layers `layer`, 0 off them; point
/// array `global_id`. Field arrays `region_names`, and the boundary of these cells, with patches between
/// regions: `patch_names`, `patch_types` (mesh/data/patch.hpp), `boundary_patch` (k), `boundary_corners`
/// (global ids, CellShape's direction) and `boundary_offsets` (k + 1, from 0). Vertices that no cell uses are
/// left out. One part is in VTK's form at a time on each rank. The files are the same bytes for any number of
/// ranks. Collective; throws CollectiveError (files) when a file cannot be written.
void write_volume(const FileMesh& mesh, const std::string& directory, const std::string& name,
                  Compression compression = Compression::none);
/// Writes a mesh of tetrahedra.
void write_volume(const mesh::NumberedMesh& mesh, const std::string& directory, const std::string& name,
                  Compression compression = Compression::none);

/// Writes DIRECTORY/NAME.pvtp and its parts in DIRECTORY/NAME/. Cell arrays `face` and `patch` (ids),
/// `quality`; field arrays `face_names` and `patch_names`; point array `global_id`. Collective, as
/// write_volume.
void write_surface(const mesh::NumberedMesh& surface, const std::string& directory, const std::string& name,
                   Compression compression = Compression::none);
/// Of the patches of a mesh.
enum class SurfaceFaces { outside, between_regions };
/// The boundary faces of a mesh, or those between its regions: triangles and quadrilaterals by part, then
/// shape, then patch. Cell arrays `piece` and `patch`; field arrays `patch_names` and `patch_types` (of all
/// patches); point array `global_id`, of the volume mesh. Collective, as write_volume.
void write_surface(const FileMesh& mesh, const std::string& directory, const std::string& name,
                   Compression compression = Compression::none, SurfaceFaces faces = SurfaceFaces::outside);

/// Writes single triangles, e.g. offenders of a failure, to one .vtp file. Not collective.
void write_triangles(const std::vector<geometry::Vec3>& points,
                     const std::vector<std::array<mesh::LocalIndex, 3>>& triangles, const std::string& file);

}  // namespace aeroloom::io
