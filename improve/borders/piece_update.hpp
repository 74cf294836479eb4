/// Exchange of tetrahedra between a piece and cavities. Used by rounds.cpp.
#pragma once

#include "improve/borders/rounds.hpp"

#include <span>

namespace aeroloom::cavities {

// A tetrahedron on its way between pieces and cavities. Vertices are given by shared-vertex keys.
struct WireTet {
  CavityId cavity;
  mesh::PieceId piece;
  mesh::RegionId region;
  std::array<mesh::SharedVertexKey, 4> vertices;
};
struct WireVertex {
  CavityId cavity;
  mesh::PieceId piece;
  std::int32_t dimension;  ///< a mesh::CadDimension; as wide as its neighbours to avoid padding
  mesh::SharedVertexKey vertex_key;
  geometry::Vec3 point;
  std::int32_t entity;
  mesh::GlobalIndex surface_number;  ///< as in mesh::Piece; -1: none
};
struct WireTriangle {
  CavityId cavity;
  mesh::PieceId piece;
  std::int32_t face;
  std::array<mesh::SharedVertexKey, 3> vertices;
  std::int32_t patch;
};

/// Rebuilds a piece without the cells that left, and with new ones. Vertices known to other pieces become
/// shared.
class PieceUpdate {
public:
  /// `vertex_keys` holds a key for every vertex of the piece, valid in this round.
  PieceUpdate(const mesh::Piece& old, const std::vector<mesh::SharedVertexKey>& vertex_keys);

  /// A cell leaves. Vertices of it that remain in the piece become shared.
  void leave(mesh::LocalIndex cell);
  void keep(mesh::LocalIndex cell);
  void keep_triangle(mesh::LocalIndex triangle) { _kept_triangles.push_back(triangle); }

  /// Returns the new piece. `vertices` must contain the vertices of `tets` that the piece does not have.
  mesh::Piece finish(std::span<const WireTet> tets, const std::vector<WireVertex>& vertices,
                     const std::vector<WireTriangle>& triangles);

private:
  struct Named {
    mesh::SharedVertexKey vertex_key;
    mesh::LocalIndex vertex;
  };

  void number_old();
  mesh::LocalIndex add(geometry::Vec3 p, mesh::CadDimension dimension, std::int32_t entity,
                       mesh::GlobalIndex surface_number);
  void add_vertices(std::span<const WireTet> tets, const std::vector<WireVertex>& vertices);
  void append_cells(std::span<const WireTet> tets);
  void append_triangles(const std::vector<WireTriangle>& triangles);
  void sort_names();
  mesh::LocalIndex find(mesh::SharedVertexKey vertex_key) const;
  void list_shared();

  const mesh::Piece& _old;
  const std::vector<mesh::SharedVertexKey>& _vertex_keys;
  mesh::Piece _piece;
  std::vector<mesh::LocalIndex> _number;  // new number of an old vertex, or -1
  std::vector<char> _named;               // per old vertex: whether it is shared now
  std::vector<mesh::LocalIndex> _kept, _kept_triangles;
  std::vector<Named> _names;  // by shared-vertex key
};

}  // namespace aeroloom::cavities
