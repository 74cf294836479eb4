#include "io/file_formats.hpp"

#include "io/cgns/cgns_writer.hpp"
#include "io/gmsh/gmsh_writer.hpp"
#include "io/medit/medit_writer.hpp"
#include "io/openfoam/openfoam_writer.hpp"
#include "io/staged_files.hpp"
#include "io/su2/su2_writer.hpp"
#include "io/ugrid/ugrid_writer.hpp"
#include "io/vtkhdf/vtkhdf_writer.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "parallel/storage/shared_file.hpp"

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aeroloom::io {

namespace {

namespace fs = std::filesystem;

/// More ends of paths than those of format_names.
constexpr std::array<std::pair<std::string_view, FileFormat>, 3> other_extensions = {{
    {".b8.ugrid", FileFormat::ugrid},
    {".b8l.ugrid", FileFormat::ugrid64},
    {".mesh", FileFormat::meshb},
}};

/// Whether a file of the format is cut into parts.
bool has_parts(FileFormat format) {
  return format == FileFormat::vtkhdf || format == FileFormat::msh_parts || format == FileFormat::openfoam;
}

/// PATH without this end.
std::string without(const std::string& path, std::string_view end) {
  return path.ends_with(end) ? path.substr(0, path.size() - end.size()) : path;
}

/// NAME.msh for NAME_1.msh, which the first of its parts is called.
std::string msh_name(const std::string& path) {
  return without(written_path(FileFormat::msh_parts, path), "_1.msh") + ".msh";
}

void write_vtu(const FileMesh& mesh, const std::string& path, const WriteOptions& options) {
  const fs::path file = without(written_path(FileFormat::vtu, path), ".pvtu");
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

/// Says what of the mesh the format has no place for.
void warn_of_losses(const FileMesh& mesh, FileFormat format, const std::string& file) {
  const bool is_su2 = format == FileFormat::su2 || format == FileFormat::su2b;
  const bool is_ugrid = format == FileFormat::ugrid || format == FileFormat::ugrid64;
  if (!is_su2 && !is_ugrid && format != FileFormat::cgns) return;
  std::vector<std::string> between;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    if (mesh.patches[p].type == mesh::PatchType::interior &&
        mesh.patch_faces[p][0] + mesh.patch_faces[p][1] > 0)
      between.push_back("'" + mesh.patches[p].name + "'");
  }
  const bool has_regions = format != FileFormat::cgns && mesh.regions.size() > 1;
  if (between.empty() && !has_regions) return;
  constexpr std::size_t shown = 5;
  const std::size_t all = between.size();
  between.resize(std::min(all, shown));
  std::string lost = has_regions ? fmt::format("its {} regions", mesh.regions.size()) : "";
  if (all > 0) {
    lost += fmt::format("{}{} patch(es) between regions: {}{}", has_regions ? " and " : "", all,
                        fmt::join(between, ", "), all > shown ? ", ..." : "");
  }
  parallel::log_warning(fmt::format(
      "'{}' has no place for {}: left out; msh, meshb, openfoam and vtkhdf keep {}", file, lost, "them"));
}

/// The case is the folder of the file, which viewers open and which holds nothing.
void write_foam(const FileMesh& mesh, const std::string& path) {
  const parallel::Communicator& communicator = mesh.pieces->communicator;
  const fs::path folder = fs::path(path).parent_path();
  write_openfoam(mesh, folder.empty() ? "." : folder.string());
  parallel::write_shared_file(communicator, path, [](parallel::SharedFile&) {});
}

void write_parts_as_they_are(const FileMesh& mesh, FileFormat format, const std::string& path,
                             const WriteOptions& options) {
  switch (format) {
    case FileFormat::vtu:
      return write_vtu(mesh, path, options);
    case FileFormat::vtkhdf:
      write_vtkhdf(mesh, path);
      return write_vtkhdf_surface(mesh, without(path, ".vtkhdf") + "_surface.vtkhdf");
    case FileFormat::cgns:
      return write_cgns(mesh, path);
    case FileFormat::meshb:
      return write_medit(mesh, path);
    case FileFormat::ugrid:
    case FileFormat::ugrid64:
      return write_ugrid(mesh, path);
    case FileFormat::su2:
      return write_su2(mesh, path);
    case FileFormat::su2b:
      return write_su2b(mesh, path);
    case FileFormat::msh:
      return write_msh(mesh, path);
    case FileFormat::msh_parts:
      return write_msh_parts(mesh, msh_name(path));
    case FileFormat::openfoam:
      break;
  }
}

}  // namespace

std::optional<FileFormat> format_of_path(const std::string& path) {
  for (const FormatName& format : format_names) {
    if (format.format != FileFormat::msh_parts && path.ends_with(format.extension)) return format.format;
  }
  for (const auto& [extension, format] : other_extensions) {
    if (path.ends_with(extension)) return format;
  }
  return std::nullopt;
}

std::string_view name_of(FileFormat format) {
  const auto found = std::find_if(format_names.begin(), format_names.end(),
                                  [&](const FormatName& name) { return name.format == format; });
  return found->name;
}

std::string known_extensions() {
  std::string text;
  for (const FormatName& format : format_names) {
    if (format.format != FileFormat::msh_parts)
      text += fmt::format("{}{}", text.empty() ? "" : ", ", format.extension);
  }
  for (const auto& [extension, format] : other_extensions) text += fmt::format(", {}", extension);
  return text;
}

std::string written_path(FileFormat format, const std::string& path) {
  if (format == FileFormat::vtu) return without(without(path, ".pvtu"), ".vtu") + ".pvtu";
  if (format == FileFormat::msh_parts) return without(without(path, "_1.msh"), ".msh") + "_1.msh";
  return path;
}

void write_mesh(const FileMesh& mesh, FileFormat format, const std::string& path,
                const WriteOptions& options) {
  const parallel::Communicator& communicator = mesh.pieces->communicator;
  const std::int32_t parts = options.parts > 0 ? options.parts : mesh.part_count;
  const bool cut = has_parts(format) && (parts != mesh.part_count || (options.recut && parts > 1));
  if (cut) {
    WriteOptions as_they_are = options;
    as_they_are.recut = false;
    return write_mesh(repartition(mesh, parts), format, path, as_they_are);
  }
  // A case is a folder with files of its user.
  if (format == FileFormat::openfoam) return write_foam(mesh, path);
  const fs::path file = written_path(format, path);
  if (communicator.is_root()) warn_of_losses(mesh, format, file.filename().string());
  write_together(
      communicator, file.parent_path().string(), file.filename().string(), [&](const std::string& staging) {
        write_parts_as_they_are(mesh, format, (fs::path(staging) / file.filename()).string(), options);
      });
  if (format == FileFormat::msh_parts) remove_later_msh_parts(communicator, msh_name(path), mesh.part_count);
}

}  // namespace aeroloom::io
