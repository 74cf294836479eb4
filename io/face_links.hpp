/// What lies behind the faces of cells, across parts and ranks.
#pragma once

#include "io/file_mesh.hpp"

#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::io {

/// Cells of a part by one number: tetrahedra first, then pyramids, then prisms. Boundary faces likewise:
/// triangles, then quadrilaterals.
struct CellOfPart {
  CellShape shape = CellShape::tetrahedron;
  mesh::LocalIndex index = 0;  ///< among those of this shape
};
CellOfPart cell_of(const FilePart& part, mesh::LocalIndex cell);
/// The place of a cell's first face in the arrays of PartLinks; its faces follow in the order of faces_of.
std::size_t first_side(const FilePart& part, mesh::LocalIndex cell);

/// The other cell at a face.
struct CellBehind {
  std::int32_t part = -1;      ///< -1: none
  mesh::LocalIndex cell = -1;  ///< of that part
  std::int32_t side = -1;      ///< of that cell

  static constexpr auto fields() {
    return std::tuple(&CellBehind::part, &CellBehind::cell, &CellBehind::side);
  }
  bool exists() const { return part >= 0; }
};

struct PartLinks {
  std::vector<CellBehind> behind;               ///< by side (first_side)
  std::vector<mesh::LocalIndex> boundary_face;  ///< by side: the part's boundary face there, -1 none
};

/// What does not fit; counts over all ranks, the same everywhere.
struct LinkDefects {
  mesh::GlobalIndex crowded_faces = 0;   ///< at which more than two cells meet
  mesh::GlobalIndex stray_faces = 0;     ///< boundary faces that are no face of a cell of their part
  mesh::GlobalIndex repeated_faces = 0;  ///< boundary faces where there is another one
  mesh::GlobalIndex open_faces = 0;      ///< faces of one cell alone without a boundary face
};

struct FaceLinks {
  std::vector<PartLinks> parts;  ///< in the order of FileMesh::parts
  LinkDefects defects;
};

/// Matches the faces of all cells by the numbers of their vertices; only sides that find no other cell in
/// their part travel. Collective.
FaceLinks link_faces(const parallel::Communicator& communicator, const FileMesh& mesh);

}  // namespace aeroloom::io
