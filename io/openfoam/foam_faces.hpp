/// The faces of a part in OpenFOAM's order.
#pragma once

#include "io/file_mesh.hpp"
#include "mesh/quality/face_links.hpp"

#include <array>
#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::io {

/// A face of the part, seen from its owner there: corners are those of `side` of `cell`, outward.
struct FoamFace {
  mesh::LocalIndex cell = 0;  ///< the owner: of the two cells in this part the lower
  std::int32_t side = 0;
  mesh::LocalIndex neighbour = -1;  ///< the other cell in this part; -1: none
  std::int32_t zone = -1;           ///< the interior patch that it lies on
  mesh::GlobalIndex number = 0;     ///< of the face in the whole mesh
  std::int8_t flipped = 0;          ///< 1: the whole mesh has it the other way round
  std::int8_t from_front = 0;       ///< 1: the owner lies in the front region of the zone
};

/// Consecutive faces towards another part.
struct FoamProcessorPatch {
  std::int32_t other = 0;
  mesh::LocalIndex count = 0;
};

/// Inner faces by owner, then neighbour; those of each patch in their order; those towards other parts, which
/// have them in the same order.
struct FoamFaces {
  std::vector<FoamFace> faces;
  mesh::LocalIndex inner = 0;
  std::vector<mesh::LocalIndex> of_patch;      ///< how many, by patch; none of interior ones
  std::vector<FoamProcessorPatch> processors;  ///< ascending part
};

/// Corners of a face as the file has them, outward from the owner; the vertex of the lowest number comes
/// first, so that both parts of a face between them begin with the same.
struct FoamCorners {
  std::array<mesh::LocalIndex, 4> corners{};
  int count = 0;
};
FoamCorners corners_of_face(const FilePart& part, const FoamFace& face);

/// The note of the other part about a face between two.
struct FoamFaceNote {
  std::int32_t zone = -1;         ///< if the other side has the boundary face
  mesh::GlobalIndex number = -1;  ///< among the inner faces of the part that tells, if its cell is the owner

  static constexpr auto fields() { return std::tuple(&FoamFaceNote::zone, &FoamFaceNote::number); }
};

/// Numbers of the whole mesh: cells part by part; faces as OpenFOAM orders them there.
struct FoamPlan {
  std::vector<mesh::GlobalIndex> first_cell;        ///< by part
  std::vector<mesh::GlobalIndex> first_inner_face;  ///< by part: of those whose owner lies there
  std::vector<mesh::GlobalIndex> first_of_patch;    ///< by patch
  mesh::GlobalIndex cells = 0, faces = 0;
  std::vector<mesh::Told<FoamFaceNote>> notes;  ///< for the parts of this rank
};

/// Throws CollectiveError (input) where faces are left open or more than two cells meet. Collective.
FoamPlan plan_faces(const FileMesh& mesh, const mesh::FaceLinks& links);

/// The faces of one part. Not collective.
FoamFaces order_faces(const FileMesh& mesh, const FilePart& part, const mesh::PieceLinks& links,
                      const FoamPlan& plan);

}  // namespace aeroloom::io
