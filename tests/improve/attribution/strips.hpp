/// Small meshes of strips, and what is found of their tetrahedra.
#pragma once

#include "improve/attribution/pinned.hpp"

#include <array>
#include <cstdint>

namespace aeroloom::attribution {

using mesh::CadDimension;
using mesh::DistributedMesh;
using mesh::Piece;

inline void add_triangle(Piece& piece, std::array<int, 3> corners, int face) {
  piece.boundary.insert(piece.boundary.end(), corners.begin(), corners.end());
  piece.triangle_face.push_back(face);
  piece.triangle_patch.push_back(face);
}

/// A narrow region of face 0 between curves 1 and `upper_curve`, in segments of length 1, one piece each: two
/// triangles with a tetrahedron on each of them.
inline DistributedMesh make_strip(const parallel::Communicator& communicator, double width, int segments,
                                  std::int32_t upper_curve) {
  DistributedMesh mesh(communicator);
  mesh.piece_count = segments;
  mesh.patches = mesh.faces = {"strip"};
  for (int i = 0; i < segments; ++i) {
    if (i % communicator.size() != communicator.rank()) continue;
    Piece piece;
    piece.id = i;
    const double x = i;
    piece.coordinates = {x, 0, 0, x + 1, 0, 0, x, width, 0, x + 1, width, 0, x + 0.5, width / 2, 1};
    piece.vertex_dimension = {CadDimension::edge, CadDimension::edge, CadDimension::edge, CadDimension::edge,
                              CadDimension::region};
    piece.vertex_entity = {1, 1, upper_curve, upper_curve, 0};
    piece.cells = {0, 1, 2, 4, 1, 3, 2, 4};
    add_triangle(piece, {0, 2, 1}, 0);
    add_triangle(piece, {1, 2, 3}, 0);
    piece.shared_vertices = {0, 1, 2, 3};
    for (const int vertex_key : {2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 3})
      piece.shared_keys.push_back(vertex_key);
    mesh.pieces.push_back(piece);
  }
  return mesh;
}

inline PinnedReport find(const DistributedMesh& mesh, double target, bool surface_may_change = true) {
  const auto world = parallel::Communicator::world();
  const mesh::NumberedMesh numbered = mesh::number_mesh(mesh);
  mesh::CellsOutside suspects{suspect_angles(target), {}};
  mesh::summarise_quality(numbered, &suspects);
  return find_pinned(numbered, target, suspects, surface_may_change);
}

}  // namespace aeroloom::attribution
