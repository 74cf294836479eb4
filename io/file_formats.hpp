/// The formats of mesh files: a row has all that the program asks of one.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace aeroloom::io {

struct FileMesh;
struct RawMesh;
struct SharedPath;
struct WriteOptions;

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

/// What the files of a format have a place for. Cells of all shapes and patches of the boundary have one in
/// every format.
struct FormatContent {
  bool regions = false;     ///< more than one
  bool interfaces = false;  ///< patches between regions
  bool parts = false;       ///< as many parts as are asked for
};

/// The end of the names of files that are read, and what such a file is.
struct ReadableEnd {
  std::string_view text;
  std::string_view description;
};

struct FormatRow {
  FileFormat format;
  std::string_view name;  ///< in the case
  /// Of paths to write; the first is that of the file of a run. What is empty is none.
  std::array<std::string_view, 2> ends;
  /// Of paths to read; none where files are read as those of another format. What is empty is none.
  std::array<ReadableEnd, 3> readable_ends = {};
  /// Null: the format is not read.
  RawMesh (*read)(const SharedPath& file) = nullptr;
  /// `path`: as written_path() has it.
  void (*write)(const FileMesh& mesh, const std::string& path, const WriteOptions& options);
  FormatContent content = {};
  /// The file has the first of `ends` whatever is asked for, for viewers go by it: PATH and PATH with this
  /// end both become PATH with that one. Empty: the file has the name that is asked for.
  std::string_view replaced_end = {};
  /// A folder with files of its user, of that name in the output directory of a run: written in its place,
  /// after all other formats. Empty: a file that appears together with those beside it.
  std::string_view folder = {};
  std::string_view announcement = "mesh";  ///< before the path when a run ends
  /// How many parts a file names; 0 where it names none. Null: files name none.
  int (*named_parts)(const std::string& path) = nullptr;
  /// Removes parts of an earlier mesh with more than `parts`. Null: there can be none.
  void (*remove_later_parts)(const SharedPath& file, std::int32_t parts) = nullptr;
  /// What to know of lengths in a unit that is not the metre. Null: files have any unit.
  std::string (*unit_warning)(const std::string& unit, double in_metres) = nullptr;
};

/// All formats, in their order.
std::span<const FormatRow> file_formats();
const FormatRow& row_of(FileFormat format);
std::string_view name_of(FileFormat format);
/// Empty where no format is called so.
std::optional<FileFormat> format_called(std::string_view name);

/// The format that a path asks for by its end; empty where none does. A single letter of byte order before
/// `.ugrid` is the writer's affair.
std::optional<FileFormat> format_of_path(const std::string& path);
/// All ends of paths that mean a format, for messages.
std::string known_extensions();

/// The file that write_mesh() makes for `path`: formats that viewers know by the end of the name alone get
/// it, .pvtu instead of .vtu, _1.msh instead of .msh; otherwise `path` itself.
std::string written_path(FileFormat format, const std::string& path);

/// The row and the readable end that a path has; null where it is not read.
struct ReadableFile {
  const FormatRow* row = nullptr;
  const ReadableEnd* end = nullptr;
};
ReadableFile readable_file(const std::string& path);
/// A path without an end, where it has it.
std::string without_end(const std::string& path, std::string_view end);

}  // namespace aeroloom::io
