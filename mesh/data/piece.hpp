/// A piece of a mesh: the unit of decomposition, work, scheduling and failure.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/cad_dimension.hpp"
#include "mesh/data/shapes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

namespace aeroloom::mesh {

using LocalIndex = std::int32_t;   ///< of a vertex or cell within a piece
using GlobalIndex = std::int64_t;  ///< of a vertex or cell of the whole mesh
using PieceId = std::int32_t;      ///< fixed by the decomposition, whatever the rank count
using RegionId = std::int32_t;     ///< of a CAD region, as in cad::Model
inline constexpr RegionId no_region = -1;
/// The name of a vertex that several pieces share, known by construction before any numbering. Equal
/// shared-vertex keys are one vertex.
using SharedVertexKey = std::uint64_t;

enum class CellKind : std::int8_t { triangle = 3, tetrahedron = 4 };

/// The cells of a piece up to `end`, from where the run before it ends, lie in `region`.
struct RegionRun {
  RegionId region = 0;
  LocalIndex end = 0;
  friend bool operator==(const RegionRun&, const RegionRun&) = default;
};

/// Flat arrays of one piece. n vertices, m cells, b boundary triangles. Cells of a volume piece (`kind`
/// tetrahedron) have positive volume; they are its tetrahedra, `cells`, and k pyramids, l prisms and h
/// hexahedra, counted in this order: cell c of m + k + l + h. Its boundary triangles, and q quadrilaterals,
/// lie on CAD faces (not on interfaces between pieces) and are counter-clockwise seen from outside the face's
/// front region. A face between two regions has its triangles and quadrilaterals in pieces of the front
/// region's cells alone. In a triangle piece the cells themselves are the boundary triangles: `boundary` is
/// empty, and `triangle_face` and `triangle_patch` run over the cells.
///
/// What a mesh of tetrahedra, one region a piece, does not have is empty and costs nothing.
struct Piece {
  PieceId id = 0;
  CellKind kind = CellKind::tetrahedron;
  RegionId region = 0;              ///< that the cells of a volume piece lie in, unless `runs` tells
  std::vector<double> coordinates;  ///< (n,3) in the unit of the CAD model
  std::vector<LocalIndex> cells;    ///< (m,3) or (m,4)
  std::vector<CadDimension> vertex_dimension;  ///< (n) of the CAD entity each lies on; empty: unknown
  std::vector<std::int32_t> vertex_entity;     ///< (n) id of that CAD entity; empty: unknown
  std::vector<LocalIndex> boundary;            ///< (b,3)
  std::vector<std::int32_t> triangle_face;     ///< (b) or (m) CAD face
  std::vector<std::int32_t> triangle_patch;    ///< (b) or (m) patch
  std::vector<LocalIndex> shared_vertices;     ///< (s) ascending: vertices that other pieces may know too
  std::vector<SharedVertexKey> shared_keys;    ///< (s)

  /// (k,5), (l,6), (h,8), corners as in mesh/data/shapes.hpp
  std::vector<LocalIndex> pyramids, prisms, hexahedra;
  std::vector<LocalIndex> quads;         ///< (q,4)
  std::vector<std::int32_t> quad_face;   ///< (q) CAD face
  std::vector<std::int32_t> quad_patch;  ///< (q) patch
  /// The regions of all cells, where they are several: ascending among the cells of a shape.
  std::vector<RegionRun> runs;
  /// Of all cells, from 1 at the wall: the boundary layer that each is of; empty: none are of any.
  std::vector<std::int16_t> layers;
  /// (n) of each vertex in the surface mesh that the volume was made from, -1 off it: while boundary layers
  /// are built. Else empty. No part of the mesh's hash.
  std::vector<GlobalIndex> surface_numbers;

  static constexpr auto fields() {
    return std::tuple(&Piece::id, &Piece::kind, &Piece::region, &Piece::coordinates, &Piece::cells,
                      &Piece::vertex_dimension, &Piece::vertex_entity, &Piece::boundary,
                      &Piece::triangle_face, &Piece::triangle_patch, &Piece::shared_vertices,
                      &Piece::shared_keys, &Piece::pyramids, &Piece::prisms, &Piece::hexahedra, &Piece::quads,
                      &Piece::quad_face, &Piece::quad_patch, &Piece::runs, &Piece::layers,
                      &Piece::surface_numbers);
  }

  int vertices_per_cell() const { return static_cast<int>(kind); }
  LocalIndex vertex_count() const { return static_cast<LocalIndex>(coordinates.size() / 3); }
  LocalIndex cell_count() const { return static_cast<LocalIndex>(cells.size() / vertices_per_cell()); }
  /// Of all shapes.
  LocalIndex total_cell_count() const {
    return cell_count() +
           static_cast<LocalIndex>(pyramids.size() / 5 + prisms.size() / 6 + hexahedra.size() / 8);
  }
  bool has_tetrahedra_alone() const {
    return pyramids.empty() && prisms.empty() && hexahedra.empty() && quads.empty();
  }
  LocalIndex boundary_count() const {
    return static_cast<LocalIndex>(kind == CellKind::triangle ? cells.size() / 3 : boundary.size() / 3);
  }
  geometry::Vec3 point(LocalIndex v) const {
    const double* p = coordinates.data() + 3 * static_cast<std::size_t>(v);
    return {p[0], p[1], p[2]};
  }
  /// The CAD face that all triangles of a surface piece lie on; -1 of an empty piece.
  std::int32_t common_face() const { return triangle_face.empty() ? -1 : triangle_face.front(); }
  void set_point(LocalIndex v, geometry::Vec3 p) {
    double* q = coordinates.data() + 3 * static_cast<std::size_t>(v);
    q[0] = p.x, q[1] = p.y, q[2] = p.z;
  }
  /// The vertices of a cell, vertices_per_cell() of them.
  const LocalIndex* cell(LocalIndex c) const {
    return cells.data() + static_cast<std::size_t>(c) * vertices_per_cell();
  }
  /// The three vertices of a boundary triangle (of a cell, in a triangle piece).
  const LocalIndex* boundary_triangle(LocalIndex t) const {
    return (kind == CellKind::triangle ? cells.data() : boundary.data()) + 3 * static_cast<std::size_t>(t);
  }
};

/// The cells of a volume piece of one shape, (m, corners).
std::span<const LocalIndex> connectivity_of(const Piece& piece, CellShape shape);
/// The boundary faces of one shape: corners, (b, corners), CAD faces and patches.
std::span<const LocalIndex> connectivity_of(const Piece& piece, FaceShape shape);
std::span<const std::int32_t> cad_faces_of(const Piece& piece, FaceShape shape);
std::span<const std::int32_t> patches_of(const Piece& piece, FaceShape shape);

/// Calls visit(region, begin, end) for the runs of the cells of one shape, counted from 0 among those.
template <class Visit>
void for_each_region_run(const Piece& piece, CellShape shape, const Visit& visit);

/// The memory that a piece occupies, bytes: its arrays with what they have reserved.
std::int64_t bytes_at_rest(const Piece& piece);

/// Faces that the cells of a piece may have at most: their indices must fit 30 bits.
inline constexpr std::size_t max_sides_per_piece = std::size_t{1} << 30;

/// Throws std::logic_error when the arrays do not fit together: sizes, index ranges, order of shared
/// vertices and of regions. Says nothing about geometry.
void require_consistent_arrays(const Piece& piece);

/// The four faces of a tetrahedron by local vertex, counter-clockwise seen from outside; face i is opposite
/// vertex i.
inline constexpr int tetrahedron_faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
/// The six edges of a tetrahedron by local vertex.
inline constexpr int tetrahedron_edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

template <class Visit>
void for_each_region_run(const Piece& piece, CellShape shape, const Visit& visit) {
  const auto count = [&](CellShape s) {
    return static_cast<LocalIndex>(connectivity_of(piece, s).size() / corners_of(s));
  };
  LocalIndex first = 0;
  for (const CellShape s : cell_shapes) {
    if (s == shape) break;
    first += count(s);
  }
  const LocalIndex last = first + count(shape);
  if (piece.runs.empty() && last > first) visit(piece.region, LocalIndex{0}, last - first);
  LocalIndex begin = 0;
  for (const RegionRun& run : piece.runs) {
    const LocalIndex from = std::max(begin, first), to = std::min(run.end, last);
    if (from < to) visit(run.region, from - first, to - first);
    begin = run.end;
  }
}

}  // namespace aeroloom::mesh
