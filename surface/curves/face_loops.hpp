/// The loops of faces as the pieces of a surface mesh have them, wherever their vertices are now.
#pragma once

#include "cad/model/model.hpp"
#include "geometry/vec.hpp"
#include "mesh/data/distributed_mesh.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace aeroloom::surface {

struct FaceLoops {
  std::vector<mesh::SharedVertexKey> vertex_keys;  ///< ascending
  std::vector<geometry::Vec3> points;              ///< by vertex
  /// Directed pairs of vertices, the face on their left, ascending. Both ways where a curve ends inside the
  /// face.
  std::vector<std::array<std::int32_t, 2>> edges;

  /// The vertex of that name, which must be there.
  std::int32_t find(mesh::SharedVertexKey vertex_key) const;
};

/// The loops of these faces (ascending, the same on every rank), each on one rank, distributed by their
/// lengths. An edge belongs to a loop where triangles of several faces meet at it; cuts between pieces are
/// none. Collective.
std::map<cad::FaceId, FaceLoops> gather_loops(const mesh::DistributedMesh& surface,
                                              std::span<const cad::FaceId> faces);

}  // namespace aeroloom::surface
