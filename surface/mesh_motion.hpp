/// How the vertices of some faces follow their boundaries when these have moved: displacements that fade with
/// the distance from the boundary, smoothed towards harmonic ones (Loehner and Yang, Commun. Numer. Meth.
/// Engng 12, 1996, doi:10.1002/(SICI)1099-0887(199610)12:10<599::AID-CNM1>3.0.CO;2-Q).
#pragma once

#include "mesh/data/distributed_mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace aeroloom::surface {

/// How far a vertex moves.
struct Displacement {
  geometry::Vec3 by;
  double distance = 0;  ///< along edges from the boundary that decides; infinite: none reaches it
  mesh::SharedVertexKey source = 0;  ///< the vertex of that boundary
  std::int64_t is_given = 0;         ///< 1 on boundaries that other faces have, and at CAD vertices
};

/// The faces that follow, and others that are meshed again afterwards; ascending, the same on every rank.
struct FollowingFaces {
  std::span<const std::int32_t> follow, again;

  bool follows(std::int32_t face) const;
  bool is_made_again(std::int32_t face) const;
};

/// By piece and vertex. Given are the displacements between both meshes, of the same pieces, of vertices that
/// a face of neither kind has. Vertices on curves between faces of both kinds follow the ends of their curve.
/// Equal in all pieces with a vertex. Collective.
std::vector<std::vector<Displacement>> find_displacements(const mesh::DistributedMesh& before,
                                                          const mesh::DistributedMesh& moved,
                                                          const FollowingFaces& faces);

}  // namespace aeroloom::surface
