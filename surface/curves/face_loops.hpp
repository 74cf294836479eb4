/// The boundary loops of faces, taken from the pieces of a surface mesh. Vertices may have moved since.
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
  /// Directed pairs of vertices, the face on their left, ascending. A curve that ends inside the face has
  /// both directions.
  std::vector<std::array<std::int32_t, 2>> edges;

  /// The vertex with this key, which must exist.
  std::int32_t find(mesh::SharedVertexKey vertex_key) const;
};

/// The loops of these faces (ascending, the same on every rank). Each is gathered on one rank, assigned by
/// length. An edge is on a loop where triangles of several faces meet. Cuts between pieces are not on loops.
/// Collective.
std::map<cad::FaceId, FaceLoops> gather_loops(const mesh::DistributedMesh& surface,
                                              std::span<const cad::FaceId> faces);

}  // namespace aeroloom::surface
