/// A wall mesh opened along its inner faces: each region's boundary by itself.
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <vector>

namespace aeroloom::layers {

/// Triangles of inner faces are here twice: once for each region, counter-clockwise seen from outside of it,
/// and with nothing beyond. A vertex is one for each part of the space around it. So a vertex of a face
/// between two regions has columns of its own on either side. Pieces are those of the wall, which have the
/// front sides of inner faces, then one for each piece of an inner face with its back sides; both are on the
/// same rank, with the same vertices and triangles. Where the space around a vertex cannot be parted, all
/// sides have that vertex.
///
/// Faces and patches of the wall come first, then two for each of them: of the front sides, of the back
/// sides.
struct OpenedWall {
  mesh::NumberedMesh mesh;
  mesh::MeshFacts before;             ///< those of the wall
  std::vector<std::int64_t> back_of;  ///< by piece here: the place of its back sides, or -1
  std::vector<std::vector<mesh::SharedVertexKey>> base_keys;  ///< by piece and shared vertex: of the wall
  std::vector<std::vector<mesh::GlobalIndex>> base_numbers;   ///< by piece and vertex: of the wall

  std::int32_t face_count() const { return static_cast<std::int32_t>(before.faces.size()); }
  std::int32_t patch_count() const { return static_cast<std::int32_t>(before.patches.size()); }
  bool is_back_piece(mesh::PieceId piece) const { return piece >= before.piece_count; }
  /// The wall's face or patch that this one is a side of; itself, where it is the wall's.
  std::int32_t base_face(std::int32_t face) const { return base_of(face, face_count()); }
  std::int32_t base_patch(std::int32_t patch) const { return base_of(patch, patch_count()); }
  bool is_front_face(std::int32_t face) const {
    return face >= face_count() && (face - face_count()) % 2 == 0;
  }
  bool is_back_face(std::int32_t face) const {
    return face >= face_count() && (face - face_count()) % 2 == 1;
  }
  std::int32_t front_of(std::int32_t base, std::int32_t count) const { return count + 2 * base; }

private:
  static std::int32_t base_of(std::int32_t side, std::int32_t count) {
    return side < count ? side : (side - count) / 2;
  }
};

/// Opens a wall whose pieces are of one CAD face each. Collective.
OpenedWall open_inner_faces(const mesh::NumberedMesh& wall);

}  // namespace aeroloom::layers
