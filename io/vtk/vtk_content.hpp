/// The mesh content of one VTK file. VTK reads in a child process (parallel/sandbox/sandbox.hpp), so a crash,
/// or too much time or memory, is an error like any other.
#pragma once

#include "io/file_mesh.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io {

/// A region or patch in a file.
struct VtkLabel {
  std::int64_t value = 0;  ///< in the array that identifies regions or patches
  mesh::Patch named;       ///< name; `type` for patches only
};

/// n points, and cells and faces with corners in CellShape's order. Corners are ids of points; without ids
/// they are the indices 0 ... n - 1.
struct VtkContent {
  std::vector<double> coordinates;     ///< (n,3)
  std::vector<mesh::GlobalIndex> ids;  ///< (n), or empty
  bool has_ids = false;                ///< also for a file without points, whose faces use ids of other files
  std::array<std::vector<mesh::GlobalIndex>, cell_shape_count> cells;
  std::array<std::vector<std::int32_t>, cell_shape_count> cell_labels;  ///< indices in `regions`
  std::array<std::vector<mesh::GlobalIndex>, face_shape_count> faces;
  std::array<std::vector<std::int32_t>, face_shape_count> face_labels;  ///< indices in `patches`
  std::vector<VtkLabel> regions, patches;
  std::size_t point_count() const { return coordinates.size() / 3; }
};

/// Reads a .vtu or legacy .vtk file. All corners exist as points; only boundary faces from field arrays may
/// use ids of other files. Throws std::ios_base::failure where the file cannot be opened,
/// otherwise std::runtime_error with the file, the place and the reason. Not collective.
VtkContent read_vtk_content(const std::string& path);

/// The file names in a .pvtu index, absolute or relative to it. Throws as read_vtk_content. Not collective.
std::vector<std::string> read_vtk_sources(const std::string& path);

/// The size of a file in bytes. Throws std::ios_base::failure where it cannot be opened.
std::int64_t readable_bytes(const std::string& path);

/// Run in the child process; only io/vtk/vtk_content.cpp calls them. Their exceptions do not name the file.
VtkContent extract_vtk_content(const std::string& path);
std::vector<std::string> extract_vtk_sources(const std::string& path);

}  // namespace aeroloom::io
