/// A mesh as a reader has found it in a file, distributed over ranks, and its assembly.
#pragma once

#include "io/file_mesh.hpp"
#include "io/shared_path.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::io {

/// The largest id of a point in a file.
inline constexpr mesh::GlobalIndex largest_id = mesh::GlobalIndex{1} << 62;

/// The points, cells and boundary faces of one rank. The lists of all ranks, one after another, have the
/// order of the file. Points have the ids of the file: any numbers from 0 to `largest_id`.
struct RawMesh {
  explicit RawMesh(SharedPath of) : file(std::move(of)) {}

  SharedPath file;                           ///< the file, and the ranks that hold the mesh
  std::vector<double> coordinates;           ///< (n,3)
  std::vector<mesh::GlobalIndex> point_ids;  ///< (n); repeated points must have equal coordinates
  std::array<std::vector<mesh::GlobalIndex>, cell_shape_count>
      cells;  ///< (m, corners) ids, in CellShape's order
  std::array<std::vector<std::int32_t>, cell_shape_count> cell_regions;  ///< (m)
  std::array<std::vector<mesh::GlobalIndex>, face_shape_count> faces;  ///< (k, corners) ids, in any direction
  std::array<std::vector<std::int32_t>, face_shape_count> face_patches;  ///< (k)
  std::vector<mesh::Patch> patches;                                      ///< the same on every rank
  std::vector<std::string> regions;  ///< the same on every rank, at least one
};

/// An assembled mesh, and counts of the corrections.
struct Assembled {
  FileMesh mesh;
  mesh::GlobalIndex turned_cells = 0, dropped_points = 0;
  mesh::GlobalIndex unnamed_faces = 0;   ///< without a patch in the file
  mesh::GlobalIndex left_out_faces = 0;  ///< of no cell, or given twice
};
/// Assembles a mesh of `parts` pieces (0: a suitable number) in the order of the file. Cells come by
/// shape, in CellShape's order. Each part gets an equal range of the cells, and owns an equal range of the
/// vertices; repartition() makes compact parts. Mirrored cells are reversed, faces directed out of the fluid,
/// and points without a cell dropped. Vertices are numbered by id. Faces that are missing in the file get
/// patches `boundary_of_REGION` or `REGION_to_REGION`. The result does not depend on the number of ranks.
/// Collective. Throws CollectiveError (input) with the path and the place: a point is missing or has two
/// positions, a corner is repeated, a coordinate is no number, a cell has no volume, cells do not conform, or
/// there are no cells.
Assembled assemble(RawMesh raw, std::int32_t parts);

}  // namespace aeroloom::io
