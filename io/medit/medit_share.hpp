/// The share of a Medit file that the readers of both encodings fill. Internal to io/medit/.
#pragma once

#include "io/file_mesh.hpp"
#include "io/medit/medit_layout.hpp"
#include "io/shared_path.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io {

/// Cells or faces of one shape, each with its reference.
struct MeditItems {
  std::vector<mesh::GlobalIndex> corners;  ///< (m, corners) from 0
  std::vector<std::int64_t> references;    ///< (m)
};

/// The share of a rank.
struct MeditShare {
  std::vector<double> coordinates;    ///< (n,3)
  mesh::GlobalIndex first_point = 0;  ///< number of the first one
  std::array<MeditItems, cell_shape_count> cells;
  std::array<MeditItems, face_shape_count> faces;

  /// Where cells or faces of this keyword go; null for others.
  MeditItems* items(std::int32_t keyword);
};

/// The corners of cells or faces of this keyword; 0 for other sections.
int medit_corners(std::int32_t keyword);
/// The name of a section of cells that are not read: hexahedra, polyhedra, curved ones; empty for all others.
std::string medit_unreadable(std::int32_t keyword);
/// Whether a section of that name, in a text file, is one of them.
bool medit_unreadable(const std::string& keyword);

/// Each rank reads its share of each section. Collective; throws CollectiveError.
MeditShare read_medit_binary(const SharedPath& file);
/// The whole file; not collective. Throws std::runtime_error with file and line.
MeditShare read_medit_text(const std::string& path);

}  // namespace aeroloom::io
