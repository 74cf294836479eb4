#include "mesh/piece.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace aeroloom::mesh {

namespace {

void require(bool fulfilled, const Piece& piece, const char* what) {
  if (!fulfilled) throw std::logic_error("piece " + std::to_string(piece.id) + ": " + what);
}

bool all_below(const std::vector<LocalIndex>& indices, LocalIndex end) {
  return std::all_of(indices.begin(), indices.end(), [end](LocalIndex v) { return v >= 0 && v < end; });
}

}  // namespace

void require_consistent_arrays(const Piece& piece) {
  const auto n = static_cast<std::size_t>(piece.vertex_count());
  const auto b = static_cast<std::size_t>(piece.boundary_count());
  require(piece.kind == CellKind::triangle || piece.kind == CellKind::tetrahedron, piece,
          "unknown cell kind");
  require(piece.coordinates.size() == 3 * n, piece, "the coordinates are no whole number of points");
  require(piece.cells.size() % piece.vertices_per_cell() == 0, piece, "the last cell is incomplete");
  require(piece.cells.size() / piece.vertices_per_cell() <= max_cells_per_piece, piece, "too many cells");
  require(piece.boundary.size() % 3 == 0, piece, "the last boundary triangle is incomplete");
  require(piece.kind == CellKind::tetrahedron || piece.boundary.empty(), piece,
          "a triangle piece with boundary triangles");
  require(piece.vertex_dimension.size() == n && piece.vertex_entity.size() == n, piece,
          "not one classification per vertex");
  require(piece.triangle_face.size() == b && piece.triangle_patch.size() == b, piece,
          "not one face and patch per boundary triangle");
  require(piece.shared_tokens.size() == piece.shared_vertices.size(), piece,
          "not one token per shared vertex");
  require(std::adjacent_find(piece.shared_vertices.begin(), piece.shared_vertices.end(),
                             std::greater_equal<>()) == piece.shared_vertices.end(),
          piece, "shared vertices are not ascending");
  require(all_below(piece.cells, piece.vertex_count()) && all_below(piece.boundary, piece.vertex_count()) &&
              all_below(piece.shared_vertices, piece.vertex_count()),
          piece, "a vertex index is out of range");
}

std::int64_t bytes_at_rest(const Piece& piece) {
  const auto bytes = [](const auto& array) {
    return static_cast<std::int64_t>(array.capacity() * sizeof(array[0]));
  };
  return static_cast<std::int64_t>(sizeof(Piece)) + bytes(piece.coordinates) + bytes(piece.cells) +
         bytes(piece.vertex_dimension) + bytes(piece.vertex_entity) + bytes(piece.boundary) +
         bytes(piece.triangle_face) + bytes(piece.triangle_patch) + bytes(piece.shared_vertices) +
         bytes(piece.shared_tokens);
}

}  // namespace aeroloom::mesh
