/// A tetrahedral piece open for local changes: cells with neighbours, qualities, and the one operation every
/// change goes through, the replacement of a cavity.
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

/// The four vertices of a tetrahedron, positive in VTK's order.
using Corners = std::array<LocalIndex, 4>;

/// One side of a face: 4 * tetrahedron + local face (opposite the local vertex). Where there is no
/// tetrahedron: -1, or -2 - i on triangle i of the piece's boundary.
using HalfFace = std::int32_t;

/// The corners of a triangle, ascending.
inline std::array<LocalIndex, 3> sorted(LocalIndex a, LocalIndex b, LocalIndex c) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  return {a, b, c};
}

/// Whether this side of a face is a triangle of the piece's boundary, and which.
inline bool is_triangle(HalfFace h) {
  return h <= -2;
}
inline LocalIndex triangle_of(HalfFace h) {
  return -2 - h;
}

/// Tetrahedra around an interior edge: (start, end, ring[i], ring[i+1]) is tets[i], of positive volume; the
/// ring is closed.
struct EdgeRing {
  LocalIndex start = 0, end = 0;
  std::vector<LocalIndex> tets;
  std::vector<LocalIndex> ring;
};

/// Tetrahedra around an edge on the boundary, from one of its triangles to the other: (start, end, ring[i],
/// ring[i+1]) is tets[i], of positive volume.
struct Fan : EdgeRing {
  std::array<LocalIndex, 2> triangles{};  ///< (start, end, ring.front()) and (start, end, ring.back())
};

/// A proposed change: the tetrahedra that go, those that come, and the worst quality of both. Triangles of
/// the boundary may go with them; what is open then becomes the new boundary, of at most as many triangles.
struct CavityReplacement {
  std::vector<LocalIndex> old_tets;
  std::vector<Corners> new_tets;
  std::vector<LocalIndex> old_triangles;
  double before = 0, after = 0;

  void clear() { old_tets.clear(), new_tets.clear(), old_triangles.clear(), before = after = 0; }
  bool improves() const { return after > before; }
};

/// Holds a piece's cells and boundary triangles while they change; vertices on faces without a neighbour,
/// shared ones, and those classified below the region are fixed.
class TetMesh {
public:
  /// Takes the cells out of the piece; finish() puts them back. Throws std::logic_error when three tetrahedra
  /// share a face. Where the boundary may not change, its triangles count as faces without a neighbour.
  TetMesh(mesh::Piece& piece, const mesh::TetQuality& measure, bool boundary_may_change = true);

  /// Slots of tetrahedra, dead ones included.
  LocalIndex slot_count() const { return static_cast<LocalIndex>(_cells.size()); }
  bool is_alive(LocalIndex t) const { return _cells[t][0] >= 0; }
  const Corners& corners(LocalIndex t) const { return _cells[t]; }
  double quality(LocalIndex t) const { return _quality[t]; }
  HalfFace twin(HalfFace h) const { return _twins[h]; }
  bool is_fixed(LocalIndex v) const { return _fixed[v] != 0; }
  /// False for vertices that a replaced cavity has swallowed.
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
  /// The lowest quality of some tetrahedra; of none, the largest double.
  double worst_of(std::span<const LocalIndex> tets) const;
  /// The local number of a vertex in a tetrahedron that has it.
  int local_vertex(LocalIndex t, LocalIndex v) const;

  /// The tetrahedra around a vertex, in an order that depends on the mesh alone.
  void collect_star(LocalIndex vertex, std::vector<LocalIndex>& tets);
  /// The tetrahedra around edge i (mesh::tetrahedron_edges) of a tetrahedron. False when the edge lies on a
  /// face without neighbour, or has more than `most` tetrahedra.
  bool collect_edge_ring(LocalIndex t, int edge, int most, EdgeRing& edge_ring) const;
  /// The tetrahedra around such an edge between two boundary triangles; false where it is none, or has more
  /// than `most` tetrahedra.
  bool collect_fan(LocalIndex t, int edge, int most, Fan& fan) const;

  /// Boundary triangle i: counter-clockwise seen from outside.
  std::array<LocalIndex, 3> triangle(LocalIndex i) const;
  /// Whether a boundary triangle may change: other pieces do not know it, and it is in use.
  bool is_free_triangle(LocalIndex i) const;
  /// Whether two boundary triangles lie on the same CAD face and patch.
  bool on_same_face(LocalIndex i, LocalIndex k) const;
  /// The CAD face of a boundary triangle.
  std::int32_t face_of(LocalIndex i) const { return _piece.triangle_face[i]; }
  mesh::CadDimension dimension(LocalIndex v) const { return _piece.vertex_dimension[v]; }
  /// The CAD entity of that dimension the vertex lies on.
  std::int32_t entity(LocalIndex v) const { return _piece.vertex_entity[v]; }
  bool is_shared(LocalIndex v) const { return _shared[v] != 0; }
  /// Boundary triangles that changed or went, those whose vertices slid among them.
  std::int64_t changed_triangles() const { return _changed_triangles; }
  void note_slid_triangles(std::size_t count) { _changed_triangles += static_cast<std::int64_t>(count); }

  /// Puts the new tetrahedra in the place of the old ones; both must fill the same space with positive
  /// volumes, up to the triangles of the boundary that change. Vertices that only old ones use are swallowed.
  /// `placed` receives the slots of the new ones.
  void replace(const CavityReplacement& cavity, std::vector<LocalIndex>& placed);
  /// Moves a vertex; `star` is all its tetrahedra.
  void move_vertex(LocalIndex v, Vec3 p, std::span<const LocalIndex> star);
  /// Moves a vertex where the qualities of the star are known already.
  void move_vertex(LocalIndex v, Vec3 p, std::span<const LocalIndex> star, std::span<const double> qualities);
  /// A new vertex inside the region that `like` lies in; to be used by the next replaced cavity.
  LocalIndex add_vertex(Vec3 p, LocalIndex like);
  /// Takes back the vertex added last.
  void drop_last_vertex();

  /// Puts the cells back: in the old order, new ones where the cavity they came from was; swallowed vertices
  /// removed.
  void finish();
  /// After that, what each vertex was numbered before, new ones after the others.
  const std::vector<LocalIndex>& origin() const { return _origin; }

private:
  struct FaceRecord {
    std::array<LocalIndex, 3> key;  ///< ascending
    HalfFace side;
    bool outer;  ///< `side` belongs to a tetrahedron outside the cavity, or is -1
  };

  void match_all_faces();
  void match_triangles();
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
  std::vector<Corners> _cells;   ///< first corner -1 in dead slots
  std::vector<HalfFace> _twins;  ///< 4 per slot
  std::vector<double> _quality;
  std::vector<LocalIndex> _incident;  ///< a tetrahedron of each vertex
  std::vector<std::uint8_t> _fixed, _shared;
  std::vector<LocalIndex> _origin;
  std::vector<LocalIndex> _place;  ///< of slots beyond the first: the original slot they are ordered after
  LocalIndex _original_count = 0;
  std::int64_t _changed_triangles = 0;
  bool _dead_triangles = false;  ///< their first vertex is -1
  std::vector<std::uint32_t> _tet_mark;
  std::uint32_t _mark = 0;
  std::vector<FaceRecord> _faces;  ///< scratch of replace, as is the next
  std::vector<LocalIndex> _cavity_vertices;
};

}  // namespace aeroloom::improve
