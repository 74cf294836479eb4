/// Medit's mesh format (GMF): keywords, and the places of the sections in a file.
#pragma once

#include "io/file_mesh.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

/// The keywords of the format that are used here (libMeshb 7, "Meshb format").
enum class MeditKeyword : std::int32_t {
  dimension = 3,
  vertices = 4,
  triangles = 6,
  quadrilaterals = 7,
  tetrahedra = 8,
  prisms = 9,
  hexahedra = 10,
  end = 54,
  pyramids = 49,
};
inline constexpr std::array<MeditKeyword, cell_shape_count> medit_cells = {
    MeditKeyword::tetrahedra, MeditKeyword::pyramids, MeditKeyword::prisms, MeditKeyword::hexahedra};
inline constexpr std::array<MeditKeyword, face_shape_count> medit_faces = {MeditKeyword::triangles,
                                                                           MeditKeyword::quadrilaterals};
/// The spelling of a keyword in text files.
std::string_view name_of(MeditKeyword keyword);

/// `binary` (.meshb): version 3 with 32-bit numbers, or version 4 with 64-bit numbers where needed.
enum class MeditEncoding : std::uint8_t { binary, text };

struct MeditCounts : ShapeCounts {
  mesh::GlobalIndex largest_reference = 1;
};

/// The vertices, or the cells or faces of one shape. Each item is a line. All lines of a section have the
/// same number of bytes, also in text files.
struct MeditSection {
  MeditKeyword keyword = MeditKeyword::end;
  int numbers = 0;         ///< numbers in a line, with the reference
  std::string header;      ///< text before the lines
  std::int64_t begin = 0;  ///< offset of the header in bytes
  std::int64_t lines = 0;  ///< offset of the first line in bytes
  std::int64_t line_bytes = 0;
  mesh::GlobalIndex count = 0;
  std::int64_t end() const { return lines + count * line_bytes; }
};

struct MeditLayout {
  MeditEncoding encoding = MeditEncoding::binary;
  int version = 3;
  int integer_width = 4;               ///< bytes (in text files characters) of a number
  std::string header;                  ///< of the file
  std::vector<MeditSection> sections;  ///< vertices, faces, cells; without empty ones
  std::string footer;
  std::int64_t footer_begin = 0;
  std::int64_t size = 0;  ///< of the file

  /// Null where the file has no such section.
  const MeditSection* find(MeditKeyword keyword) const;
};

/// The places of all sections, from counts alone. `wide`: binary files get 64-bit numbers even where 32 bits
/// suffice.
MeditLayout medit_layout(const MeditCounts& counts, MeditEncoding encoding, bool wide = false);

}  // namespace aeroloom::io
