/// A tetrahedral piece that local operations can change. It knows the neighbours and qualities of its cells,
/// and offers one operation: the replacement of a cavity.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"
#include "mesh/quality/tet_quality.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::improve {

using geometry::Vec3;
using mesh::LocalIndex;

/// The four vertices of a tetrahedron, with positive volume in VTK's order.
using Corners = std::array<LocalIndex, 4>;

/// A face seen from one side: 4 * tetrahedron + local face; local face i is opposite local vertex i. Other
/// values say that there is no tetrahedron: -2 - i is boundary triangle i, and -1 means neither.
using HalfFace = std::int32_t;

/// The corners of a triangle, ascending.
inline std::array<LocalIndex, 3> sorted(LocalIndex a, LocalIndex b, LocalIndex c) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c};
}

/// Whether the value of a side means a boundary triangle, and which.
inline bool is_triangle(HalfFace h) {
  return h <= -2;
}
inline LocalIndex triangle_of(HalfFace h) {
  return -2 - h;
}

/// The tetrahedra around an interior edge. tets[i] has the vertices (start, end, ring[i], ring[i+1]) in
/// positive order; the ring is closed.
struct EdgeRing {
  LocalIndex start = 0, end = 0;
  std::vector<LocalIndex> tets;
  std::vector<LocalIndex> ring;
};

/// The tetrahedra around a boundary edge, from one of its boundary triangles to the other. The ring is open.
struct Fan : EdgeRing {
  std::array<LocalIndex, 2> triangles{};  ///< (start, end, ring.front()) and (start, end, ring.back())
};

/// A proposed change: tetrahedra to remove, tetrahedra to insert, and the worst quality of each set. Boundary
/// triangles may be removed too. Faces that are then open become the new boundary, with at most as many
/// triangles.
struct CavityReplacement {
  std::vector<LocalIndex> old_tets;
  std::vector<Corners> new_tets;
  std::vector<LocalIndex> old_triangles;
  double before = 0, after = 0;

  void clear() { old_tets.clear(), new_tets.clear(), old_triangles.clear(), before = after = 0; }
  bool improves() const { return after > before; }
};

/// The cells and boundary triangles of a piece while they change. A vertex is fixed if it is shared, or
/// classified on the boundary, or on a face without neighbour. A triangle between two tetrahedra is of a
/// baffle: it is the boundary of both, which are no neighbours. It stays, and its vertices count as shared.
class TetMesh {
public:
  /// Takes the cells out of the piece; finish() puts them back. Without `boundary_may_change`, boundary
  /// triangles count as faces without neighbour. Throws std::logic_error if three tetrahedra share a face.
  TetMesh(mesh::Piece& piece, const mesh::TetQuality& measure, bool boundary_may_change = true);

  /// Number of slots for tetrahedra, unused ones included.
  LocalIndex slot_count() const { return static_cast<LocalIndex>(_cells.size()); }
  bool is_alive(LocalIndex t) const { return _cells[t][0] >= 0; }
  const Corners& corners(LocalIndex t) const { return _cells[t]; }
  double quality(LocalIndex t) const { return _quality[t]; }
  HalfFace twin(HalfFace h) const { return _twins[h]; }
  bool is_fixed(LocalIndex v) const { return _fixed[v] != 0; }
  /// False for vertices of replaced cavities that no tetrahedron has any more.
  bool is_used(LocalIndex v) const { return _incident[v] >= 0; }
  LocalIndex vertex_count() const { return _piece.vertex_count(); }
  Vec3 point(LocalIndex v) const { return _piece.point(v); }
  std::array<Vec3, 4> points(LocalIndex t) const {
    const Corners& c = _cells[t];
    return {point(c[0]), point(c[1]), point(c[2]), point(c[3])};
  }
  const mesh::TetQuality& measure() const { return _measure; }
  double quality_of(const Corners& c) const {
    return _measure(point(c[0]), point(c[1]), point(c[2]), point(c[3]));
  }
  bool is_positive(const Corners& c) const {
    return geometry::has_positive_volume(point(c[0]), point(c[1]), point(c[2]), point(c[3]));
  }
  /// The lowest quality of the given tetrahedra; the largest double if there are none.
  double worst_of(std::span<const LocalIndex> tets) const;
  /// The local number of a vertex in one of its tetrahedra.
  int local_vertex(LocalIndex t, LocalIndex v) const;

  /// The tetrahedra around a vertex, in an order that depends only on the mesh.
  void collect_star(LocalIndex vertex, std::vector<LocalIndex>& tets);
  /// The tetrahedra around edge i (mesh::tetrahedron_edges) of a tetrahedron. False if the edge is on a face
  /// without neighbour or has more than `most` tetrahedra.
  bool collect_edge_ring(LocalIndex t, int edge, int most, EdgeRing& edge_ring) const;
  /// The same for a boundary edge between two boundary triangles; false for other edges.
  bool collect_fan(LocalIndex t, int edge, int most, Fan& fan) const;

  /// Boundary triangle i, counter-clockwise seen from outside.
  std::array<LocalIndex, 3> triangle(LocalIndex i) const;
  /// Whether a boundary triangle exists and may change: not all its vertices are shared.
  bool is_free_triangle(LocalIndex i) const;
  /// Whether two boundary triangles lie on the same CAD face and patch.
  bool on_same_face(LocalIndex i, LocalIndex k) const;
  /// The CAD face of a boundary triangle.
  std::int32_t face_of(LocalIndex i) const { return _piece.triangle_face[i]; }
  mesh::CadDimension dimension(LocalIndex v) const { return _piece.vertex_dimension[v]; }
  /// The CAD entity of that dimension that the vertex lies on.
  std::int32_t entity(LocalIndex v) const { return _piece.vertex_entity[v]; }
  bool is_shared(LocalIndex v) const { return _shared[v] != 0; }
  /// Number of boundary triangles that changed, vanished or had a vertex slide.
  std::int64_t changed_triangles() const { return _changed_triangles; }
  void note_slid_triangles(std::size_t count) { _changed_triangles += static_cast<std::int64_t>(count); }

  /// Whether a change has tetrahedra on both sides of the same baffle triangles as before.
  bool keeps_baffles(const CavityReplacement& cavity) const;

  /// Replaces tetrahedra. Old and new ones must fill the same space with positive volumes, but for boundary
  /// triangles that change. Vertices of old tetrahedra only become unused. `placed` receives the slots of the
  /// new ones.
  void replace(const CavityReplacement& cavity, std::vector<LocalIndex>& placed);
  /// Moves a vertex; `star` holds all its tetrahedra.
  void move_vertex(LocalIndex v, Vec3 p, std::span<const LocalIndex> star);
  /// The same with the new qualities of the star given.
  void move_vertex(LocalIndex v, Vec3 p, std::span<const LocalIndex> star, std::span<const double> qualities);
  /// Adds a vertex inside the region of vertex `like`, for the next replacement.
  LocalIndex add_vertex(Vec3 p, LocalIndex like);
  /// Removes the vertex added last.
  void drop_last_vertex();

  /// Puts the cells back into the piece: in the old order, new ones in the places of their cavities. Removes
  /// unused vertices.
  void finish();
  /// After finish(): the former number of each vertex; new vertices have higher numbers.
  const std::vector<LocalIndex>& origin() const { return _origin; }

private:
  struct FaceRecord {
    std::array<LocalIndex, 3> key;  ///< ascending
    HalfFace side;
    bool outer;  ///< `side` belongs to a tetrahedron outside the cavity, or is -1
  };

  void match_all_faces();
  void match_triangles(bool boundary_may_change);
  void part_at_baffles(std::span<const std::array<LocalIndex, 3>> keys, std::span<const LocalIndex> triangles,
                       bool boundary_may_change);
  void open_boundary(const FaceRecord& record, LocalIndex triangle);
  void match_boundary(const CavityReplacement& cavity);
  void fix_vertices();
  void match_cavity_faces();
  void take_slots(const CavityReplacement& cavity, std::vector<LocalIndex>& placed);
  void order_cells();
  void remove_unused_vertices();
  std::array<LocalIndex, 3> face_key(HalfFace h) const;
  void next_mark();

  mesh::Piece& _piece;
  mesh::TetQuality _measure;
  std::vector<Corners> _cells;   ///< first corner -1 in unused slots
  std::vector<HalfFace> _twins;  ///< 4 per slot
  std::vector<double> _quality;
  std::vector<LocalIndex> _incident;  ///< one tetrahedron of each vertex
  std::vector<std::uint8_t> _fixed, _shared;
  std::vector<LocalIndex> _origin;
  std::vector<LocalIndex>
      _place;  ///< of slots beyond the original ones: the original slot that they follow in order
  LocalIndex _original_count = 0;
  std::vector<std::array<LocalIndex, 3>> _baffles;  ///< triangles between two tetrahedra, ascending
  std::int64_t _changed_triangles = 0;
  bool _dead_triangles = false;  ///< triangles that vanished have -1 as first vertex
  std::vector<std::uint32_t> _tet_mark;
  std::uint32_t _mark = 0;
  std::vector<FaceRecord> _faces;  ///< working memory of replace(), like the next
  std::vector<LocalIndex> _cavity_vertices;
};

}  // namespace aeroloom::improve
