/// Puts the faces of a part into OpenFOAM's order.
#pragma once

#include "io/file_mesh.hpp"
#include "mesh/quality/face_links.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace aeroloom::io {

/// A face of the part. Its corners are those of side `side` of the owner cell, directed outward.
struct FoamFace {
  mesh::LocalIndex cell = 0;  ///< the owner: the lower of the two cells in this part
  std::int32_t side = 0;
  mesh::LocalIndex neighbour = -1;  ///< the other cell in this part, or -1
  std::int32_t zone = -1;           ///< the interior patch of the face, or -1
  mesh::GlobalIndex number = 0;     ///< of the face in the whole mesh
  std::int8_t flipped = 0;          ///< 1: in the whole mesh the other cell is the owner
  std::int8_t from_front = 0;       ///< 1: the owner lies in the front region of the zone
};

/// Consecutive faces between this part and another one.
struct FoamProcessorPatch {
  std::int32_t other = 0;
  mesh::LocalIndex count = 0;
};

/// The inner faces by owner, then neighbour; the faces of each patch; then the faces between this part and
/// others, which the other parts have in the same order.
struct FoamFaces {
  std::vector<FoamFace> faces;
  mesh::LocalIndex inner = 0;
  std::vector<mesh::LocalIndex> of_patch;      ///< number of faces by patch; 0 for interior patches
  std::vector<FoamProcessorPatch> processors;  ///< by ascending part
};

/// The corners of a face in the file, directed outward from the owner. The vertex of lowest number comes
/// first, so that both parts begin a common face with the same vertex.
struct FoamCorners {
  std::array<mesh::LocalIndex, 4> corners{};
  int count = 0;
};
FoamCorners corners_of_face(const MeshPart& part, const FoamFace& face);

/// What a part tells another part about a common face.
struct FoamFaceNote {
  std::int32_t zone = -1;         ///< the interior patch, if the sender has the boundary face
  mesh::GlobalIndex number = -1;  ///< among the inner faces of the sender, if its cell is the owner
};

/// Numbers in the undecomposed mesh: cells by part, and faces in OpenFOAM's order.
struct FoamPlan {
  std::vector<mesh::GlobalIndex> first_cell;        ///< by part
  std::vector<mesh::GlobalIndex> first_inner_face;  ///< by part of the owner
  std::vector<mesh::GlobalIndex> first_of_patch;    ///< by patch
  mesh::GlobalIndex cells = 0, faces = 0;
  std::vector<mesh::Told<FoamFaceNote>> notes;  ///< received by the parts of this rank
};

/// Throws CollectiveError (input) where a face has no cell or boundary beyond it, or more than two cells.
/// Collective.
FoamPlan plan_faces(const FileMesh& mesh, const mesh::FaceLinks& links);

/// The faces of one part. Not collective.
FoamFaces order_faces(const FileMesh& mesh, const MeshPart& part, const mesh::PieceLinks& links,
                      const FoamPlan& plan);

}  // namespace aeroloom::io
