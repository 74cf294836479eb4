/// The boundary of a mesh as a file has it: matched with its cells. Internal to io/.
#pragma once

#include "io/raw_mesh.hpp"
#include "mesh/transfer/build_pieces.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace aeroloom::io {

/// The share of one rank with its points numbered: corners are places in `numbers`.
struct NumberedShare {
  SharedPath file;                         ///< that it comes from
  std::vector<mesh::GlobalIndex> numbers;  ///< ascending; of the points that cells here use
  std::vector<std::uint8_t> shared;        ///< by place: 1 where cells of other shares use the point too
  std::array<std::vector<mesh::LocalIndex>, cell_shape_count> cells;
  std::array<std::vector<std::int32_t>, cell_shape_count> regions;
  std::array<std::vector<std::int32_t>, cell_shape_count> pieces;  ///< where each cell goes
  /// By number of point in the whole mesh, any direction.
  std::array<std::vector<mesh::GlobalIndex>, face_shape_count> faces;
  std::array<std::vector<std::int32_t>, face_shape_count> patches;
};

/// The boundary faces with their patches, and counts of those that the file did not have right.
struct MatchedFaces {
  decltype(mesh::PieceItems::faces) items;
  mesh::DistributedMesh names;     ///< patches, their types, faces of the model, their sides, regions
  mesh::GlobalIndex unnamed = 0;   ///< faces that the file left without a patch
  mesh::GlobalIndex left_out = 0;  ///< faces of the file inside a region, of no cell, or given twice
};

/// Gives each boundary face the piece of its cell and orients it out of that; faces that the file left out
/// get patches of their own, `boundary_of_REGION` and `REGION_to_REGION`. A patch with faces between regions
/// beside others becomes two. Each patch is a face of the model for each region that it bounds, or each two
/// that it lies between, called like the patch, and by its regions where the patch has several. Throws
/// CollectiveError (input) with the path where more than two cells meet at a face, or two on the same side of
/// it. Collective.
MatchedFaces match_boundary(const NumberedShare& share, std::vector<mesh::Patch> patches,
                            const std::vector<std::string>& regions);

}  // namespace aeroloom::io
