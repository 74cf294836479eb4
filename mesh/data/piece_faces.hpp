/// The faces of the cells of one piece, of all shapes, by their vertices.
#pragma once

#include "geometry/vec.hpp"
#include "mesh/data/piece.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace aeroloom::mesh {

/// The corners of a face, ascending; a triangle's last is -1.
template <class Index>
using FaceKey = std::array<Index, 4>;

template <class Index>
FaceKey<Index> face_key(FaceKey<Index> corners) {
  const auto order = [&](std::size_t i, std::size_t j) {
    if (corners[j] < corners[i]) std::swap(corners[i], corners[j]);
  };
  order(0, 1), order(1, 2), order(0, 1);
  if (corners[3] >= 0) order(2, 3), order(1, 2), order(0, 1);
  return corners;
}

/// The corners of a cell's face as vertices, counter-clockwise from outside; a triangle's last is -1.
template <class Index>
FaceKey<Index> corners_at(const CellFace& face, const Index* cell) {
  FaceKey<Index> corners{};
  for (std::size_t k = 0; k < 4; ++k) corners[k] = face[k] < 0 ? Index{-1} : cell[face[k]];
  return corners;
}

/// Whether two ways round the same corners are the same, or the same the other way round. Corners of a
/// quadrilateral may be in an order that is neither.
template <class Index>
bool same_direction(const FaceKey<Index>& a, const FaceKey<Index>& b) {
  const std::size_t corners = a[3] < 0 ? 3 : 4;
  std::size_t at = 0;
  while (at < corners && b[at] != a[0]) ++at;
  return b[(at + 1) % corners] == a[1] && b[(at + 2) % corners] == a[2];
}
template <class Index>
bool opposite_direction(FaceKey<Index> a, const FaceKey<Index>& b) {
  std::swap(a[1], a[a[3] < 0 ? 2 : 3]);
  return same_direction(a, b);
}

/// One that has the face: a side of a cell (cell and side), or a boundary face (side -1 and its number).
struct FaceUser {
  LocalIndex item = -1;
  std::int32_t side = -1;
  bool is_cell() const { return side >= 0; }
};

/// Sorts items, equal ones in their order; few of them without allocating memory.
template <class Iterator, class Less>
void sort_stably(Iterator begin, Iterator end, const Less& less) {
  constexpr std::ptrdiff_t few = 48;
  if (end - begin > few) return std::stable_sort(begin, end, less);
  for (Iterator i = begin; i != end; ++i) {
    for (Iterator j = i; j != begin && less(*j, *(j - 1)); --j) std::swap(*j, *(j - 1));
  }
}

/// Calls `visit(key, users)` once for each set of equal faces among `cells` and boundary faces, in the order
/// of lowest vertices. `source` has for_each_side(sink(corners, cell, side)) and for_each_face(
/// sink(corners, face)), the same in every call; vertices run from 0 to `vertices` - 1.
template <class Source, class Visit>
void match_faces(std::size_t vertices, const Source& source, const Visit& visit) {
  struct FaceEntry {
    std::array<LocalIndex, 3> rest;
    FaceUser user;
  };
  std::vector<std::size_t> first(vertices + 2, 0);
  const auto lowest = [](const FaceKey<LocalIndex>& c) {
    return std::min({c[0], c[1], c[2], c[3] < 0 ? c[0] : c[3]});
  };
  source.for_each_side(
      [&](const FaceKey<LocalIndex>& c, LocalIndex, std::int32_t) { ++first[lowest(c) + 2]; });
  source.for_each_face([&](const FaceKey<LocalIndex>& c, LocalIndex) { ++first[lowest(c) + 2]; });
  for (std::size_t v = 2; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<FaceEntry> entries(first.back());
  const auto put = [&](const FaceKey<LocalIndex>& corners, FaceUser user) {
    const auto key = face_key(corners);
    entries[first[key[0] + 1]++] = {{key[1], key[2], key[3]}, user};
  };
  source.for_each_side([&](const FaceKey<LocalIndex>& c, LocalIndex cell, std::int32_t side) {
    put(c, {cell, side});
  });
  source.for_each_face([&](const FaceKey<LocalIndex>& c, LocalIndex face) { put(c, {face, -1}); });
  std::vector<FaceUser> users;
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto begin = entries.begin() + static_cast<std::ptrdiff_t>(first[v]);
    const auto end = entries.begin() + static_cast<std::ptrdiff_t>(first[v + 1]);
    sort_stably(begin, end, [](const FaceEntry& a, const FaceEntry& b) { return a.rest < b.rest; });
    for (auto i = begin; i != end;) {
      users.clear();
      const auto& rest = i->rest;
      auto j = i;
      for (; j != end && j->rest == rest; ++j) users.push_back(j->user);
      visit(FaceKey<LocalIndex>{static_cast<LocalIndex>(v), rest[0], rest[1], rest[2]},
            std::span<const FaceUser>(users));
      i = j;
    }
  }
}

/// A cell of a volume piece among those of its shape.
struct CellOfPiece {
  CellShape shape = CellShape::tetrahedron;
  LocalIndex index = 0;
};
inline CellOfPiece cell_of(const Piece& piece, LocalIndex cell) {
  if (cell < piece.cell_count()) return {CellShape::tetrahedron, cell};
  cell -= piece.cell_count();
  const auto pyramids = static_cast<LocalIndex>(piece.pyramids.size() / 5);
  if (cell < pyramids) return {CellShape::pyramid, cell};
  cell -= pyramids;
  const auto prisms = static_cast<LocalIndex>(piece.prisms.size() / 6);
  return cell < prisms ? CellOfPiece{CellShape::prism, cell}
                       : CellOfPiece{CellShape::hexahedron, cell - prisms};
}
/// Its vertices.
inline const LocalIndex* vertices_of(const Piece& piece, CellOfPiece cell) {
  return connectivity_of(piece, cell.shape).data() +
         static_cast<std::size_t>(cell.index) * static_cast<std::size_t>(corners_of(cell.shape));
}
/// The points of its vertices; returns how many.
inline int points_of(const Piece& piece, CellOfPiece cell, geometry::Vec3* points) {
  const LocalIndex* v = vertices_of(piece, cell);
  const int count = corners_of(cell.shape);
  for (int k = 0; k < count; ++k) points[k] = piece.point(v[k]);
  return count;
}

/// The first cell of a shape, which the piece need not have.
inline LocalIndex first_cell(const Piece& piece, CellShape shape) {
  LocalIndex first = 0;
  for (const CellShape before : cell_shapes) {
    if (before == shape) break;
    first += static_cast<LocalIndex>(connectivity_of(piece, before).size() /
                                     static_cast<std::size_t>(corners_of(before)));
  }
  return first;
}

/// The *sides* of a piece are the faces of its cells, cell by cell in the order of faces_of. The first side
/// of a cell, for the number of cells that of all sides.
inline std::size_t first_side(const Piece& piece, LocalIndex cell) {
  if (cell <= piece.cell_count()) return 4 * static_cast<std::size_t>(cell);
  const LocalIndex beyond =
      piece.hexahedra.empty() ? 0 : std::max(0, cell - first_cell(piece, CellShape::hexahedron));
  return 5 * static_cast<std::size_t>(cell) - static_cast<std::size_t>(piece.cell_count() - beyond);
}
/// A cell and one of its faces.
struct SideOfCell {
  LocalIndex cell = 0;
  std::int32_t side = 0;
};
inline SideOfCell cell_at_side(const Piece& piece, std::size_t side) {
  const std::size_t of_tetrahedra = first_side(piece, piece.cell_count());
  if (side < of_tetrahedra) return {static_cast<LocalIndex>(side / 4), static_cast<std::int32_t>(side % 4)};
  const LocalIndex hexahedra = first_cell(piece, CellShape::hexahedron);
  const std::size_t to_hexahedra = first_side(piece, hexahedra);
  if (side >= to_hexahedra) {
    side -= to_hexahedra;
    return {hexahedra + static_cast<LocalIndex>(side / 6), static_cast<std::int32_t>(side % 6)};
  }
  side -= of_tetrahedra;
  return {piece.cell_count() + static_cast<LocalIndex>(side / 5), static_cast<std::int32_t>(side % 5)};
}

/// The boundary faces of a piece are counted triangles first, then quadrilaterals.
inline LocalIndex boundary_face_count(const Piece& piece) {
  return piece.boundary_count() + static_cast<LocalIndex>(piece.quad_face.size());
}
inline std::int32_t cad_face_of(const Piece& piece, LocalIndex face) {
  return face < piece.boundary_count() ? piece.triangle_face[face]
                                       : piece.quad_face[face - piece.boundary_count()];
}

inline std::int32_t patch_of(const Piece& piece, LocalIndex face) {
  return face < piece.boundary_count() ? piece.triangle_patch[face]
                                       : piece.quad_patch[face - piece.boundary_count()];
}
/// The corners of a boundary face (of a cell, in a triangle piece).
inline std::span<const LocalIndex> corners_of_boundary(const Piece& piece, LocalIndex face) {
  if (face < piece.boundary_count()) return {piece.boundary_triangle(face), 3};
  return std::span(piece.quads).subspan(4 * static_cast<std::size_t>(face - piece.boundary_count()), 4);
}

/// Removes the boundary triangles of a volume piece for which keep(triangle) is false.
template <class Keep>
void keep_boundary_triangles(Piece& piece, const Keep& keep) {
  std::size_t kept = 0;
  for (LocalIndex t = 0; t < piece.boundary_count(); ++t) {
    if (!keep(t)) continue;
    std::copy_n(piece.boundary_triangle(t), 3, piece.boundary.data() + 3 * kept);
    piece.triangle_face[kept] = piece.triangle_face[t];
    piece.triangle_patch[kept] = piece.triangle_patch[t];
    ++kept;
  }
  piece.boundary.resize(3 * kept);
  piece.triangle_face.resize(kept);
  piece.triangle_patch.resize(kept);
}

/// The edges of boundary faces are counted face by face.
struct EdgeOfFace {
  LocalIndex face = 0;
  int edge = 0;  ///< from this corner to the next
};
inline std::int64_t first_edge(const Piece& piece, LocalIndex face) {
  return std::int64_t{3} * face + std::max(0, face - piece.boundary_count());
}
inline EdgeOfFace face_at_edge(const Piece& piece, std::int64_t edge) {
  const std::int64_t of_triangles = first_edge(piece, piece.boundary_count());
  if (edge < of_triangles) return {static_cast<LocalIndex>(edge / 3), static_cast<int>(edge % 3)};
  edge -= of_triangles;
  return {piece.boundary_count() + static_cast<LocalIndex>(edge / 4), static_cast<int>(edge % 4)};
}

/// The region of a cell.
inline RegionId region_of(const Piece& piece, LocalIndex cell) {
  if (piece.runs.empty()) return piece.region;
  return std::upper_bound(piece.runs.begin(), piece.runs.end(), cell,
                          [](LocalIndex c, const RegionRun& run) { return c < run.end; })
      ->region;
}

/// The cells and boundary faces of a volume piece, for match_faces.
class PieceFaces {
public:
  explicit PieceFaces(const Piece& piece) : _piece(piece) {}

  template <class Sink>
  void for_each_side(const Sink& sink) const {
    LocalIndex cell = 0;
    for (const CellShape shape : cell_shapes) {
      const std::span<const LocalIndex> corners = connectivity_of(_piece, shape);
      const auto faces = faces_of(shape);
      const auto n = static_cast<std::size_t>(corners_of(shape));
      for (std::size_t i = 0; i < corners.size(); i += n, ++cell) {
        for (std::size_t side = 0; side < faces.size(); ++side)
          sink(corners_at(faces[side], corners.data() + i), cell, static_cast<std::int32_t>(side));
      }
    }
  }

  template <class Sink>
  void for_each_face(const Sink& sink) const {
    for (LocalIndex f = 0; f < boundary_face_count(_piece); ++f) sink(face(f), f);
  }

  FaceKey<LocalIndex> side(LocalIndex cell, std::int32_t side) const {
    const CellOfPiece place = cell_of(_piece, cell);
    return corners_at(faces_of(place.shape)[static_cast<std::size_t>(side)], vertices_of(_piece, place));
  }
  FaceKey<LocalIndex> face(LocalIndex face) const {
    if (face < _piece.boundary_count()) {
      const LocalIndex* v = _piece.boundary_triangle(face);
      return {v[0], v[1], v[2], -1};
    }
    const LocalIndex* v = _piece.quads.data() + 4 * static_cast<std::size_t>(face - _piece.boundary_count());
    return {v[0], v[1], v[2], v[3]};
  }

private:
  const Piece& _piece;
};

}  // namespace aeroloom::mesh
