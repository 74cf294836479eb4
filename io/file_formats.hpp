/// The formats of mesh files. A row of the table has all that the program needs to know of a format.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

struct FileMesh;
struct RenamedName;
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

/// The compression of the arrays in files of VTK.
enum class Compression { none, lz4, zlib };

/// What the files of a format can hold, besides cells of all shapes and boundary patches.
struct FormatContent {
  bool regions = false;     ///< several regions
  bool interfaces = false;  ///< faces between regions
  bool parts = false;       ///< any number of parts
};

/// The ending of file names that are read, and a description of such files.
struct ReadableEnd {
  std::string_view text;
  std::string_view description;
};

struct FormatRow {
  FileFormat format;
  std::string_view name;  ///< in the case file
  /// The endings of paths to write. The first one is that of the output of a run. Empty entries do not count.
  std::array<std::string_view, 2> ends;
  /// The endings of paths to read; none if files are read as those of another format.
  std::array<ReadableEnd, 3> readable_ends = {};
  /// Null: the format cannot be read.
  RawMesh (*read)(const SharedPath& file) = nullptr;
  /// `path`: a result of written_path().
  void (*write)(const FileMesh& mesh, const std::string& path, const WriteOptions& options);
  FormatContent content = {};
  /// An ending that ends.front() replaces, because viewers need the latter: PATH and PATH with this ending
  /// become PATH with ends.front(). Empty: a file has the name that the user gives.
  std::string_view replaced_end = {};
  /// The folder in the output directory where the user edits files (OpenFOAM). It is written in place, after
  /// all other formats. Empty: the format writes files, which appear together with their companions.
  std::string_view folder = {};
  std::string_view announcement = "mesh";  ///< the word before the path when a run ends
  /// The number of files that an index file names. Null: the format has no index files.
  int (*named_parts)(const std::string& path) = nullptr;
  /// Removes the files of parts from `parts` on, of an earlier mesh. Null: the format has no such files.
  void (*remove_later_parts)(const SharedPath& file, std::int32_t parts) = nullptr;
  /// Names that files cannot hold as they are. Null: files hold all names. Not collective.
  std::vector<RenamedName> (*renamed)(const FileMesh& mesh) = nullptr;
  /// Whether the solvers that read the files take lengths for metres.
  bool in_metres = false;
  /// Whether the solvers that read the files have their unknowns in the centres of cells.
  bool cell_centred = false;
  /// The command of the format that scales a mesh by a factor. Null: there is none.
  std::string (*scaling)(double factor) = nullptr;
};

/// All formats, in the order of FileFormat.
std::span<const FormatRow> file_formats();
const FormatRow& row_of(FileFormat format);
std::string_view name_of(FileFormat format);
/// The format with this name in the case file, if any.
std::optional<FileFormat> format_called(std::string_view name);

/// The format that the ending of a path means, if any. The UGRID writer checks the letters before `.ugrid`.
std::optional<FileFormat> format_of_path(const std::string& path);
/// All endings of paths that mean a format, for messages.
std::string known_extensions();

/// The file that write_mesh() makes for `path`: .pvtu instead of .vtu, _1.msh instead of .msh, because
/// viewers need these endings; otherwise `path`.
std::string written_path(FileFormat format, const std::string& path);

/// The row and the ending of a path that can be read; null for other paths.
struct ReadableFile {
  const FormatRow* row = nullptr;
  const ReadableEnd* end = nullptr;
};
ReadableFile readable_file(const std::string& path);
/// The path without the ending `end`, or the path itself if it ends otherwise.
std::string without_end(const std::string& path, std::string_view end);

}  // namespace aeroloom::io
