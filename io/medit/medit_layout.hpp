/// Medit's mesh format (GMF): keywords, and where the sections of a file lie.
#pragma once

#include "io/file_mesh.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace aeroloom::io {

/// Keywords of the format that a mesh of ours needs (libMeshb 7, "Meshb format").
enum class MeditKeyword : std::int32_t {
  dimension = 3,
  vertices = 4,
  triangles = 6,
  quadrilaterals = 7,
  tetrahedra = 8,
  prisms = 9,
  end = 54,
  pyramids = 49,
};
inline constexpr std::array<MeditKeyword, cell_shape_count> medit_cells = {
    MeditKeyword::tetrahedra, MeditKeyword::pyramids, MeditKeyword::prisms};
inline constexpr std::array<MeditKeyword, face_shape_count> medit_faces = {MeditKeyword::triangles,
                                                                           MeditKeyword::quadrilaterals};
/// The keyword as text files have it.
std::string_view name_of(MeditKeyword keyword);

/// `binary` (.meshb) is version 3, with 32-bit numbers, or 4, with 64-bit numbers, where they do not suffice.
enum class MeditEncoding : std::uint8_t { binary, text };

struct MeditCounts : ShapeCounts {
  mesh::GlobalIndex largest_reference = 1;
};

/// Lines of one kind: vertices, or cells or faces of one shape. All lines have the same number of bytes, in
/// text files too.
struct MeditSection {
  MeditKeyword keyword = MeditKeyword::end;
  int numbers = 0;         ///< in a line, with the reference
  std::string header;      ///< in front of the lines
  std::int64_t begin = 0;  ///< of the header, in bytes
  std::int64_t lines = 0;  ///< where the first line begins
  std::int64_t line_bytes = 0;
  mesh::GlobalIndex count = 0;
  std::int64_t end() const { return lines + count * line_bytes; }
};

struct MeditLayout {
  MeditEncoding encoding = MeditEncoding::binary;
  int version = 3;
  int integer_width = 4;               ///< bytes of a number; in text files characters
  std::string header;                  ///< of the file
  std::vector<MeditSection> sections;  ///< vertices, then faces, then cells, those that there are
  std::string footer;
  std::int64_t footer_begin = 0;
  std::int64_t size = 0;  ///< of the file

  /// Null where there are none.
  const MeditSection* find(MeditKeyword keyword) const;
};

/// Where everything goes, from counts alone.
/// `wide`: 64-bit numbers in binary files even where 32 bits suffice.
MeditLayout medit_layout(const MeditCounts& counts, MeditEncoding encoding, bool wide = false);

}  // namespace aeroloom::io
