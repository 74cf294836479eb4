#include "io/file_formats.hpp"

#include "io/cgns/cgns_writer.hpp"
#include "io/gmsh/gmsh_reader.hpp"
#include "io/gmsh/gmsh_writer.hpp"
#include "io/medit/medit_reader.hpp"
#include "io/medit/medit_writer.hpp"
#include "io/openfoam/openfoam_writer.hpp"
#include "io/renamed_names.hpp"
#include "io/su2/su2_reader.hpp"
#include "io/su2/su2_writer.hpp"
#include "io/ugrid/ugrid_reader.hpp"
#include "io/ugrid/ugrid_writer.hpp"
#include "io/vtk/vtk_reader.hpp"
#include "io/vtk/vtk_writer.hpp"
#include "io/vtkhdf/vtkhdf_reader.hpp"
#include "io/vtkhdf/vtkhdf_writer.hpp"
#include "io/write_mesh.hpp"
#include "parallel/storage/shared_file.hpp"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::io {

namespace {

namespace fs = std::filesystem;

/// A writer that needs no options.
template <void (*write)(const FileMesh&, const std::string&)>
void plain(const FileMesh& mesh, const std::string& path, const WriteOptions&) {
  write(mesh, path);
}

void write_pvtu(const FileMesh& mesh, const std::string& path, const WriteOptions& options) {
  const fs::path file = without_end(path, ".pvtu");
  const std::string folder = file.parent_path().string(), name = file.filename().string();
  write_volume(mesh, folder, name, options.compression);
  if (!options.surface) return;
  write_surface(mesh, folder, name + "_surface", options.compression);
  const bool has_interfaces = std::any_of(mesh.patches.begin(), mesh.patches.end(), [](const auto& patch) {
    return patch.type == mesh::PatchType::interior;
  });
  if (has_interfaces) {
    write_surface(mesh, folder, name + "_interfaces", options.compression, SurfaceFaces::between_regions);
  }
}

void write_vtkhdf_with_surface(const FileMesh& mesh, const std::string& path) {
  write_vtkhdf(mesh, path);
  write_vtkhdf_surface(mesh, without_end(path, ".vtkhdf") + "_surface.vtkhdf");
}

/// NAME.msh for NAME_1.msh, which the first of its parts is called.
std::string msh_name(const std::string& path) {
  return without_end(path, "_1.msh") + ".msh";
}

void write_msh_from_first(const FileMesh& mesh, const std::string& path) {
  write_msh_parts(mesh, msh_name(path));
}

void remove_msh_after(const SharedPath& file, std::int32_t parts) {
  remove_later_msh_parts({file.communicator, msh_name(file.path)}, parts);
}

void write_meshb(const FileMesh& mesh, const std::string& path) {
  write_medit(mesh, path);
}

/// The case is the folder of the file, which viewers open and which holds nothing.
void write_foam(const FileMesh& mesh, const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  write_openfoam(mesh, folder.empty() ? "." : folder.string());
  parallel::write_shared_file(mesh.communicator(), path, [](parallel::SharedFile&) {});
}

constexpr FormatContent whole_mesh{.regions = true, .interfaces = true};
constexpr FormatContent whole_mesh_in_parts{.regions = true, .interfaces = true, .parts = true};
constexpr FormatContent one_region{};

constexpr FormatRow format_rows[] = {
    {.format = FileFormat::vtu,
     .name = "vtu",
     .ends = {".pvtu"},
     .readable_ends = {{{".vtu", "VTK XML (.vtu)"},
                        {".pvtu", "VTK XML in parts (.pvtu)"},
                        {".vtk", "VTK legacy (.vtk)"}}},
     .read = read_vtk,
     .write = write_pvtu,
     .content = whole_mesh,
     .replaced_end = ".vtu",
     .announcement = "open in ParaView",
     .named_parts = parts_named_in_pvtu},
    {.format = FileFormat::vtkhdf,
     .name = "vtkhdf",
     .ends = {".vtkhdf"},
     .readable_ends = {{{".vtkhdf", "VTKHDF"}}},
     .read = read_vtkhdf,
     .write = plain<write_vtkhdf_with_surface>,
     .content = whole_mesh_in_parts},
    {.format = FileFormat::cgns,
     .name = "cgns",
     .ends = {".cgns"},
     .write = plain<write_cgns>,
     .content = {.regions = true},
     .renamed = renamed_in_cgns,
     .in_metres = true},
    // A single letter of byte order before `.ugrid` is the writer's affair.
    {.format = FileFormat::ugrid,
     .name = "ugrid",
     .ends = {".lb8.ugrid", ".b8.ugrid"},
     .readable_ends = {{{".ugrid", "UGRID"}}},
     .read = read_ugrid,
     .write = plain<write_ugrid>,
     .content = one_region,
     .renamed = renamed_in_ugrid},
    {.format = FileFormat::ugrid64,
     .name = "ugrid64",
     .ends = {".lb8l.ugrid", ".b8l.ugrid"},
     .readable_ends = {{{".ugrid64", "UGRID, 64-bit"}}},
     .read = read_ugrid,
     .write = plain<write_ugrid>,
     .content = one_region,
     .renamed = renamed_in_ugrid},
    {.format = FileFormat::su2,
     .name = "su2",
     .ends = {".su2"},
     .readable_ends = {{{".su2", "SU2, text"}}},
     .read = read_su2,
     .write = plain<write_su2>,
     .content = one_region,
     .renamed = renamed_in_su2,
     .in_metres = true},
    {.format = FileFormat::su2b,
     .name = "su2b",
     .ends = {".su2b"},
     .readable_ends = {{{".su2b", "SU2, binary"}}},
     .read = read_su2b,
     .write = plain<write_su2b>,
     .content = one_region,
     .renamed = renamed_in_su2,
     .in_metres = true},
    {.format = FileFormat::msh,
     .name = "msh",
     .ends = {".msh"},
     .readable_ends = {{{".msh", "Gmsh MSH"}}},
     .read = read_msh,
     .write = plain<write_msh>,
     .content = whole_mesh,
     .renamed = renamed_in_msh},
    {.format = FileFormat::msh_parts,
     .name = "msh_parts",
     .ends = {"_1.msh"},
     .read = read_msh,
     .write = plain<write_msh_from_first>,
     .content = whole_mesh_in_parts,
     .replaced_end = ".msh",
     .remove_later_parts = remove_msh_after,
     .renamed = renamed_in_msh},
    {.format = FileFormat::meshb,
     .name = "meshb",
     .ends = {".meshb", ".mesh"},
     .readable_ends = {{{".mesh", "Medit (GMF), text"}, {".meshb", "Medit (GMF), binary"}}},
     .read = read_medit,
     .write = plain<write_meshb>,
     .content = whole_mesh},
    {.format = FileFormat::openfoam,
     .name = "openfoam",
     .ends = {".foam"},
     .write = plain<write_foam>,
     .content = whole_mesh_in_parts,
     .folder = "openfoam",
     .renamed = renamed_in_openfoam,
     .in_metres = true,
     .cell_centred = true,
     .scaling = openfoam_scaling},
};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < std::size(format_rows); ++i)
    if (static_cast<std::size_t>(format_rows[i].format) != i) return false;
  return true;
}
static_assert(is_in_order());

}  // namespace

std::string without_end(const std::string& path, std::string_view end) {
  return path.ends_with(end) ? path.substr(0, path.size() - end.size()) : path;
}

std::span<const FormatRow> file_formats() {
  return format_rows;
}

const FormatRow& row_of(FileFormat format) {
  const auto number = static_cast<std::size_t>(format);
  if (number >= std::size(format_rows)) throw std::logic_error("a format of files has no row");
  return format_rows[number];
}

std::optional<FileFormat> format_called(std::string_view name) {
  for (const FormatRow& row : format_rows)
    if (row.name == name) return row.format;
  return std::nullopt;
}

std::optional<FileFormat> format_of_path(const std::string& path) {
  for (const FormatRow& row : file_formats()) {
    for (const std::string_view end : row.ends)
      if (!end.empty() && path.ends_with(end)) return row.format;
  }
  return std::nullopt;
}

std::string_view name_of(FileFormat format) {
  return row_of(format).name;
}

std::string known_extensions() {
  std::string first, further;
  for (const FormatRow& row : file_formats()) {
    for (const std::string_view end : row.ends) {
      // A part of several files is not asked for by the end of its name.
      if (end.empty() || format_of_path(std::string(end)) != row.format) continue;
      (end == row.ends.front() ? first : further) += fmt::format(", {}", end);
    }
  }
  return (first + further).substr(2);
}

std::string written_path(FileFormat format, const std::string& path) {
  const FormatRow& row = row_of(format);
  if (row.replaced_end.empty()) return path;
  return without_end(without_end(path, row.ends.front()), row.replaced_end).append(row.ends.front());
}

ReadableFile readable_file(const std::string& path) {
  for (const FormatRow& row : format_rows) {
    for (const ReadableEnd& end : row.readable_ends)
      if (!end.text.empty() && path.ends_with(end.text)) return {&row, &end};
  }
  return {};
}

}  // namespace aeroloom::io
