/// One VTK file as a mesh reader wants it. VTK reads in a child process (parallel/sandbox/sandbox.hpp): what
/// it crashes on, or takes too much time or memory for, is an error like any other.
#pragma once

#include "io/file_mesh.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

namespace aeroloom::io {

/// A region or patch as a file knows it.
struct VtkLabel {
  std::int64_t value = 0;  ///< in the array that tells them apart
  mesh::Patch named;       ///< its name; `type` of patches only

  static constexpr auto fields() { return std::tuple(&VtkLabel::value, &VtkLabel::named); }
};

/// n points, cells and faces by corners in CellShape's order. Corners are ids of points; without ids they are
/// 0 .. n - 1, in their order.
struct VtkPart {
  std::vector<double> coordinates;     ///< (n,3)
  std::vector<mesh::GlobalIndex> ids;  ///< (n), or empty where there are none
  bool has_ids = false;                ///< a part without points may have ids: its faces have those of others
  std::array<std::vector<mesh::GlobalIndex>, cell_shape_count> cells;
  std::array<std::vector<std::int32_t>, cell_shape_count> cell_labels;  ///< into `regions`
  std::array<std::vector<mesh::GlobalIndex>, face_shape_count> faces;
  std::array<std::vector<std::int32_t>, face_shape_count> face_labels;  ///< into `patches`
  std::vector<VtkLabel> regions, patches;

  static constexpr auto fields() {
    return std::tuple(&VtkPart::coordinates, &VtkPart::ids, &VtkPart::has_ids, &VtkPart::cells,
                      &VtkPart::cell_labels, &VtkPart::faces, &VtkPart::face_labels, &VtkPart::regions,
                      &VtkPart::patches);
  }
  std::size_t point_count() const { return coordinates.size() / 3; }
};

/// Reads a .vtu or legacy .vtk file. Corners are points that exist, but for the ids of boundary faces that
/// come from field arrays. Throws std::filesystem::filesystem_error where it cannot be opened,
/// std::runtime_error naming the file, the place and what is wrong otherwise. Not collective.
VtkPart read_vtk_part(const std::string& path);

/// The files that a .pvtu index names, as they stand there: relative to it or absolute. Throws as
/// read_vtk_part. Not collective.
std::vector<std::string> read_vtk_sources(const std::string& path);

/// The size of a file in bytes. Throws std::filesystem::filesystem_error unless it is one and can be opened.
std::int64_t readable_bytes(const std::string& path);

/// The child's task; io/vtk/vtk_part.cpp alone calls it. Texts of exceptions do not name the file.
VtkPart extract_vtk_part(const std::string& path);
std::vector<std::string> extract_vtk_sources(const std::string& path);

}  // namespace aeroloom::io
