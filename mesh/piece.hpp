/// A piece of a simplicial mesh: the unit of decomposition, work, scheduling and failure.
#pragma once

#include "geometry/vec.hpp"

#include <cstddef>
#include <cstdint>
#include <tuple>
#include <vector>

namespace aeroloom::mesh {

using LocalIndex = std::int32_t;   ///< of a vertex or cell within a piece
using GlobalIndex = std::int64_t;  ///< of a vertex or cell of the whole mesh
using PieceId = std::int32_t;      ///< fixed by the decomposition, whatever the rank count
using RegionId = std::int32_t;     ///< of a CAD region, as in cad::Model
inline constexpr RegionId no_region = -1;
/// The name of a vertex that several pieces share, known by construction before any numbering. Equal tokens
/// are one vertex.
using SharedToken = std::uint64_t;

enum class CellKind : std::int8_t { triangle = 3, tetrahedron = 4 };

/// Flat arrays of one piece. n vertices, m cells, b boundary triangles. Cells of a tetrahedral piece have
/// positive volume in VTK's order and lie in one region; its boundary triangles lie on CAD faces (not on
/// interfaces between pieces) and are counter-clockwise seen from outside the face's front region. A face
/// between two regions has its triangles in pieces of the front region alone. In a triangle piece the cells
/// themselves are the boundary triangles: `boundary` is empty, and `triangle_face` and `triangle_patch` run
/// over the cells.
struct Piece {
  PieceId id = 0;
  CellKind kind = CellKind::tetrahedron;
  RegionId region = 0;                        ///< that the cells of a tetrahedral piece lie in
  std::vector<double> coordinates;            ///< (n,3) in the unit of the CAD model
  std::vector<LocalIndex> cells;              ///< (m,3) or (m,4)
  std::vector<std::int8_t> vertex_dimension;  ///< (n) 0 CAD vertex, 1 edge, 2 face, 3 region
  std::vector<std::int32_t> vertex_entity;    ///< (n) id of that CAD entity
  std::vector<LocalIndex> boundary;           ///< (b,3)
  std::vector<std::int32_t> triangle_face;    ///< (b) or (m) CAD face
  std::vector<std::int32_t> triangle_patch;   ///< (b) or (m) patch
  std::vector<LocalIndex> shared_vertices;    ///< (s) ascending: vertices that other pieces may know too
  std::vector<SharedToken> shared_tokens;     ///< (s)

  static constexpr auto fields() {
    return std::tuple(&Piece::id, &Piece::kind, &Piece::region, &Piece::coordinates, &Piece::cells,
                      &Piece::vertex_dimension, &Piece::vertex_entity, &Piece::boundary,
                      &Piece::triangle_face, &Piece::triangle_patch, &Piece::shared_vertices,
                      &Piece::shared_tokens);
  }

  int vertices_per_cell() const { return static_cast<int>(kind); }
  LocalIndex vertex_count() const { return static_cast<LocalIndex>(coordinates.size() / 3); }
  LocalIndex cell_count() const { return static_cast<LocalIndex>(cells.size() / vertices_per_cell()); }
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

/// What a piece occupies in memory, bytes: its arrays with what they have reserved.
std::int64_t bytes_at_rest(const Piece& piece);

/// Cells a piece may hold at most: indices of faces must fit 30 bits.
inline constexpr std::size_t max_cells_per_piece = std::size_t{1} << 28;

/// Throws std::logic_error when the arrays do not fit together: sizes, index ranges, order of shared
/// vertices. Says nothing about geometry.
void require_consistent_arrays(const Piece& piece);

/// The four faces of a tetrahedron by local vertex, counter-clockwise seen from outside; face i is opposite
/// vertex i.
inline constexpr int tetrahedron_faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
/// The six edges of a tetrahedron by local vertex.
inline constexpr int tetrahedron_edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

}  // namespace aeroloom::mesh
