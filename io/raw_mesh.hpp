/// The mesh of a file as it stands there: on each rank a share of its points, cells and boundary faces.
#pragma once

#include "io/file_mesh.hpp"
#include "io/shared_path.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::io {

/// Of a point in a file.
inline constexpr mesh::GlobalIndex largest_id = mesh::GlobalIndex{1} << 62;

/// The share of one rank. Shares follow each other by rank: the order of the file is that of all shares one
/// after another. Points are known by the ids of the file: any distinct numbers from 0 to `largest_id`.
struct RawMesh {
  explicit RawMesh(SharedPath of) : file(std::move(of)) {}

  SharedPath file;                           ///< that the mesh comes from, and the ranks that hold it
  std::vector<double> coordinates;           ///< (n,3)
  std::vector<mesh::GlobalIndex> point_ids;  ///< (n); a point may come several times, with the same bits
  std::array<std::vector<mesh::GlobalIndex>, cell_shape_count>
      cells;  ///< (m, corners) of ids, in CellShape's order
  std::array<std::vector<std::int32_t>, cell_shape_count> cell_regions;  ///< (m)
  std::array<std::vector<mesh::GlobalIndex>, face_shape_count> faces;  ///< (k, corners) of ids, any direction
  std::array<std::vector<std::int32_t>, face_shape_count> face_patches;  ///< (k)
  std::vector<mesh::Patch> patches;                                      ///< the same on every rank
  std::vector<std::string> regions;  ///< the same on every rank, one at least
};

/// A mesh and what had to be done to it.
struct Assembled {
  FileMesh mesh;
  mesh::GlobalIndex turned_cells = 0, dropped_points = 0;
  mesh::GlobalIndex unnamed_faces = 0;   ///< without a patch in the file
  mesh::GlobalIndex left_out_faces = 0;  ///< inside a region, of no cell, or given twice
};
/// Puts the shares together as a mesh of `parts` pieces (0: of what suits its size), in the order of the
/// file: part k gets the k-th share of cells (tetrahedra first, then pyramids, then prisms) and owns the k-th
/// share of vertices. repartition() makes compact parts. Cells whose corners come in mirrored order are
/// turned over, faces oriented out of the fluid; points that no cell uses are dropped; vertices are numbered
/// in the order of ids. Faces of cells that the file leaves open become patches `boundary_of_REGION` or
/// `REGION_to_REGION`. Throws CollectiveError (input) with the path and the place: a point that does not
/// exist or comes twice with different coordinates, a corner twice, coordinates that are no numbers, a
/// tetrahedron without volume, cells that do not conform, no cells at all. Collective; the same for any
/// number of ranks.
Assembled assemble(RawMesh raw, std::int32_t parts);

}  // namespace aeroloom::io
