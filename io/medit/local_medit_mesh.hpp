/// The items of a Medit file on one rank, as the readers of both encodings find them. Internal to io/medit/.
#pragma once

#include "io/file_mesh.hpp"
#include "io/medit/medit_layout.hpp"
#include "io/shared_path.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io {

/// The cells or faces of one shape, each with its reference (an integer label).
struct MeditItems {
  std::vector<mesh::GlobalIndex> corners;  ///< (m, corners) from 0
  std::vector<std::int64_t> references;    ///< (m)
};

/// The points, cells and faces of one rank.
struct LocalMeditMesh {
  std::vector<double> coordinates;    ///< (n,3)
  mesh::GlobalIndex first_point = 0;  ///< number of the first point
  std::array<MeditItems, cell_shape_count> cells;
  std::array<MeditItems, face_shape_count> faces;

  /// The list for cells or faces with this keyword; null for other keywords.
  MeditItems* items(std::int32_t keyword);
};

/// The number of corners of cells or faces with this keyword; 0 for other sections.
int medit_corners(std::int32_t keyword);
/// The name of a section with cells that cannot be read: polyhedra, curved cells; else empty.
std::string medit_unreadable(std::int32_t keyword);
/// Whether a text file calls such a section `keyword`.
bool medit_unreadable(const std::string& keyword);

/// Each rank reads its range of each section. Collective; throws CollectiveError.
LocalMeditMesh read_medit_binary(const SharedPath& file);
/// Reads the whole file. Not collective. Throws std::runtime_error with the file and the line.
LocalMeditMesh read_medit_text(const std::string& path);

}  // namespace aeroloom::io
