/// Writes meshes for ParaView: .pvtu with .vtu files, .pvtp with .vtp files, in binary appended form.
/// Coordinates and global ids have 64 bits; the points of a cell, which are indices in the file, have 32.
#pragma once

#include "io/file_formats.hpp"
#include "io/file_mesh.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace aeroloom::io {

/// The number of cells of a .vtu file in a mesh of `cells` cells. Viewers show faces between files as
/// boundary, so meshes of common size get one or two files. Larger meshes get about fifty, which as many
/// ranks write, and never more than five hundred.
constexpr mesh::GlobalIndex cells_per_vtk_file(mesh::GlobalIndex cells) {
  constexpr mesh::GlobalIndex most = 1'000'000, least = 200'000, largest_whole = 2'000'000, most_files = 500;
  const mesh::GlobalIndex of_large = most * largest_whole / std::max<mesh::GlobalIndex>(cells, 1);
  return std::max(std::clamp(of_large, least, most), cells / most_files);
}

/// Writes DIRECTORY/NAME.pvtu, and .vtu files with consecutive parts of the mesh in DIRECTORY/NAME/, each of
/// cells_per_vtk_file() cells. Cells come by part, shape, region. Point array: `global_id`. Cell arrays:
/// `piece` (the part), `region`, `mean_ratio`, `min_dihedral` (io/vtk/cell_quality.hpp), and `layer` in
/// meshes with boundary layers (0 outside them). Field arrays: `region_names`, `patch_names`, `patch_types`
/// (mesh/data/patch.hpp), and k boundary faces of these cells, also between regions: `boundary_patch` (k),
/// `boundary_corners` (global ids, CellShape's direction), `boundary_offsets` (k + 1, from 0). Vertices
/// without a cell are left out. A rank holds one file at a time in VTK's form. The bytes do not depend on the
/// number of ranks. Collective; throws CollectiveError (files) where a file cannot be written.
void write_volume(const FileMesh& mesh, const std::string& directory, const std::string& name,
                  Compression compression = Compression::none);

/// Writes a surface mesh to DIRECTORY/NAME.pvtp, with .vtp files in DIRECTORY/NAME/. Cell arrays: `piece`,
/// `face` and `patch` (ids), `quality`. Field arrays: `face_names`, `patch_names`. Point array: `global_id`.
/// Collective, as write_volume.
void write_surface(const mesh::NumberedMesh& surface, const std::string& directory, const std::string& name,
                   Compression compression = Compression::none);
/// The boundary patches of a mesh, or the patches between its regions.
enum class SurfaceFaces { outside, between_regions };
/// Writes the boundary faces of a mesh, or the faces between its regions: triangles and quadrilaterals by
/// part, shape, patch. Cell arrays: `piece`, `patch`. Field arrays: `patch_names` and `patch_types` of all
/// patches. Point array: `global_id` of the volume mesh. Collective, as write_volume.
void write_surface(const FileMesh& mesh, const std::string& directory, const std::string& name,
                   Compression compression = Compression::none, SurfaceFaces faces = SurfaceFaces::outside);

/// Writes single triangles, for example those of a failed check, to one .vtp file. Not collective.
void write_triangles(const std::vector<geometry::Vec3>& points,
                     const std::vector<std::array<mesh::LocalIndex, 3>>& triangles, const std::string& file);

}  // namespace aeroloom::io
