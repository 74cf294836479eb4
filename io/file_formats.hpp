/// The formats of mesh files, and writing by their names.
#pragma once

#include "io/file_mesh.hpp"
#include "io/vtk/vtk_writer.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace aeroloom::io {

enum class FileFormat : std::uint8_t {
  vtu,        ///< .pvtu with .vtu parts, XML
  vtkhdf,     ///< VTKHDF, one file with parts
  cgns,       ///< CGNS/HDF5
  ugrid,      ///< UGRID, little-endian, 32-bit indices
  ugrid64,    ///< UGRID, little-endian, 64-bit indices
  su2,        ///< SU2, text
  su2b,       ///< SU2, binary
  msh,        ///< Gmsh MSH 4.1, binary, one file
  msh_parts,  ///< Gmsh MSH 4.1, binary, a file for each part
  meshb,      ///< Medit (GMF), binary
  openfoam,   ///< OpenFOAM, a case with processor folders
};

/// A format, and the file that it makes of a mesh called `mesh`.
struct FormatName {
  FileFormat format;
  std::string_view name;       ///< in the case
  std::string_view extension;  ///< of the file or folder
};
inline constexpr std::array<FormatName, 11> format_names = {{
    {FileFormat::vtu, "vtu", ".pvtu"},
    {FileFormat::vtkhdf, "vtkhdf", ".vtkhdf"},
    {FileFormat::cgns, "cgns", ".cgns"},
    {FileFormat::ugrid, "ugrid", ".lb8.ugrid"},
    {FileFormat::ugrid64, "ugrid64", ".lb8l.ugrid"},
    {FileFormat::su2, "su2", ".su2"},
    {FileFormat::su2b, "su2b", ".su2b"},
    {FileFormat::msh, "msh", ".msh"},
    {FileFormat::msh_parts, "msh_parts", "_1.msh"},
    {FileFormat::meshb, "meshb", ".meshb"},
    {FileFormat::openfoam, "openfoam", ".foam"},
}};

/// The format that a path asks for by its end; empty where none does. A single letter of byte order before
/// `.ugrid` is the writer's affair.
std::optional<FileFormat> format_of_path(const std::string& path);
std::string_view name_of(FileFormat format);
/// All ends of paths that mean a format, for messages.
std::string known_extensions();

/// The file that write_mesh() makes for `path`: formats that viewers know by the end of the name alone get
/// it, .pvtu instead of .vtu, _1.msh instead of .msh; otherwise `path` itself.
std::string written_path(FileFormat format, const std::string& path);

struct WriteOptions {
  std::int32_t parts = 0;                       ///< of formats that come in parts; 0: those of the mesh
  Compression compression = Compression::none;  ///< of .vtu and .vtp
  /// Parts are cut anew even where the mesh has as many: those of assemble() are runs of the file's cells,
  /// which may lie anywhere, and own vertices that they do not use.
  bool recut = false;
  /// Beside NAME.pvtu the boundary as NAME_surface.pvtp, and faces between regions, where there are some, as
  /// NAME_interfaces.pvtp. NAME.vtkhdf has its surface always.
  bool surface = false;
};

/// Writes a mesh to written_path(format, path); what lies beside it (`.mapbc`, folders of
/// parts, surfaces for viewers) takes its name from there, and appears together with it or not at all
/// (write_together; OpenFOAM: its mesh does). Formats in parts get as many as asked for, cut anew by
/// repartition() where the mesh has others. Never gathers; the files depend on the parts, not on ranks.
/// Collective; throws CollectiveError (files) where something cannot be written, (input) where the format
/// cannot hold the mesh.
void write_mesh(const FileMesh& mesh, FileFormat format, const std::string& path,
                const WriteOptions& options);

}  // namespace aeroloom::io
