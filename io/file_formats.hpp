/// The formats of mesh files, and what is read and written by their names.
#pragma once

#include "io/file_mesh.hpp"
#include "io/raw_mesh.hpp"

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

/// Whether a file of the format is cut into parts, so that the parts of the mesh matter.
bool has_parts(FileFormat format);

}  // namespace aeroloom::io
