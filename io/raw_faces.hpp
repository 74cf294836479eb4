/// Matches the boundary faces of a file with its cells. Internal to io/.
#pragma once

#include "io/raw_mesh.hpp"
#include "mesh/transfer/build_pieces.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io {

/// The cells and faces of one rank after points have numbers. Corners of cells are indices in `numbers`.
struct LocalMesh {
  SharedPath file;                         ///< the file that it comes from
  std::vector<mesh::GlobalIndex> numbers;  ///< ascending; the points of the cells on this rank
  std::vector<std::uint8_t> shared;        ///< by index: 1 where cells of other ranks use the point too
  std::array<std::vector<mesh::LocalIndex>, cell_shape_count> cells;
  std::array<std::vector<std::int32_t>, cell_shape_count> regions;
  std::array<std::vector<std::int32_t>, cell_shape_count> pieces;  ///< the piece of each cell
  /// Corners by number in the whole mesh, in any direction.
  std::array<std::vector<mesh::GlobalIndex>, face_shape_count> faces;
  std::array<std::vector<std::int32_t>, face_shape_count> patches;
};

/// The boundary faces with their patches, and counts of the corrections.
struct MatchedFaces {
  decltype(mesh::PieceItems::faces) items;
  mesh::DistributedMesh names;     ///< patches, types, faces of the model, their sides, regions
  mesh::GlobalIndex unnamed = 0;   ///< faces without a patch in the file
  mesh::GlobalIndex left_out = 0;  ///< faces of no cell, or repeated
};

/// Finds the piece of each boundary face, and directs the face out of its cell. Faces that are missing in the
/// file get new patches, `boundary_of_REGION` and `REGION_to_REGION`. A patch with boundary faces and faces
/// between regions is split. A patch is a face of the model for each region that it bounds, and for each pair
/// of regions that it separates. Such a face has the name of the patch; if there are several, also of its
/// regions. Faces of the file inside of a region are those of a baffle, with the region on both sides. Throws
/// CollectiveError (input) with the path where more than two cells have a common face, or two lie on the same
/// side of it. Collective.
MatchedFaces match_boundary(const LocalMesh& local, std::vector<mesh::Patch> patches,
                            const std::vector<std::string>& regions);

}  // namespace aeroloom::io
