#include "mesh/data/piece.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace aeroloom::mesh {

namespace {

void require(bool fulfilled, const Piece& piece, const char* what) {
  if (!fulfilled) throw std::logic_error("piece " + std::to_string(piece.id) + ": " + what);
}

std::size_t side_count(const Piece& piece) {
  return 4 * (piece.cells.size() / piece.vertices_per_cell()) + piece.pyramids.size() +
         5 * piece.prisms.size() / 6 + 6 * piece.hexahedra.size() / 8;
}

/// Runs end where the cells do, one after another; regions ascend among the cells of a shape.
void require_region_runs(const Piece& piece) {
  if (piece.runs.empty()) return;
  LocalIndex end = 0;
  for (const RegionRun& run : piece.runs) {
    require(run.end > end, piece, "the runs of regions do not ascend");
    end = run.end;
  }
  require(end == piece.total_cell_count(), piece, "the runs of regions do not end with the cells");
  for (const CellShape shape : cell_shapes) {
    RegionId last = -1;
    for_each_region_run(piece, shape, [&](RegionId region, LocalIndex, LocalIndex) {
      require(region > last, piece, "the regions of cells of one shape do not ascend");
      last = region;
    });
  }
}

bool all_below(const std::vector<LocalIndex>& indices, LocalIndex end) {
  return std::all_of(indices.begin(), indices.end(), [end](LocalIndex v) { return v >= 0 && v < end; });
}

}  // namespace

std::span<const LocalIndex> connectivity_of(const Piece& piece, CellShape shape) {
  switch (shape) {
    case CellShape::tetrahedron:
      return piece.cells;
    case CellShape::pyramid:
      return piece.pyramids;
    case CellShape::prism:
      return piece.prisms;
    case CellShape::hexahedron:
      return piece.hexahedra;
  }
  throw std::logic_error("no such shape of a cell");
}

std::span<const LocalIndex> connectivity_of(const Piece& piece, FaceShape shape) {
  return shape == FaceShape::triangle ? piece.boundary : piece.quads;
}

std::span<const std::int32_t> cad_faces_of(const Piece& piece, FaceShape shape) {
  return shape == FaceShape::triangle ? piece.triangle_face : piece.quad_face;
}

std::span<const std::int32_t> patches_of(const Piece& piece, FaceShape shape) {
  return shape == FaceShape::triangle ? piece.triangle_patch : piece.quad_patch;
}

void require_consistent_arrays(const Piece& piece) {
  const auto n = static_cast<std::size_t>(piece.vertex_count());
  const auto b = static_cast<std::size_t>(piece.boundary_count());
  require(piece.kind == CellKind::triangle || piece.kind == CellKind::tetrahedron, piece,
          "unknown cell kind");
  require(piece.coordinates.size() == 3 * n, piece, "the coordinates are no whole number of points");
  require(piece.cells.size() % piece.vertices_per_cell() == 0, piece, "the last cell is incomplete");
  require(piece.pyramids.size() % 5 == 0 && piece.prisms.size() % 6 == 0 && piece.hexahedra.size() % 8 == 0,
          piece, "the last cell is incomplete");
  require(side_count(piece) <= max_sides_per_piece, piece, "too many cells");
  require(piece.boundary.size() % 3 == 0, piece, "the last boundary triangle is incomplete");
  require(piece.quads.size() % 4 == 0, piece, "the last boundary quadrilateral is incomplete");
  require(piece.kind == CellKind::tetrahedron || piece.boundary.empty(), piece,
          "a triangle piece with boundary triangles");
  require(piece.kind == CellKind::tetrahedron || (piece.has_tetrahedra_alone() && piece.runs.empty()), piece,
          "a triangle piece with other cells or regions");
  require((piece.vertex_dimension.size() == n && piece.vertex_entity.size() == n) ||
              (piece.vertex_dimension.empty() && piece.vertex_entity.empty()),
          piece, "not one classification per vertex");
  require(piece.surface_numbers.size() == n || piece.surface_numbers.empty(), piece,
          "not one surface number per vertex");
  require(piece.triangle_face.size() == b && piece.triangle_patch.size() == b, piece,
          "not one face and patch per boundary triangle");
  require(
      4 * piece.quad_face.size() == piece.quads.size() && 4 * piece.quad_patch.size() == piece.quads.size(),
      piece, "not one face and patch per boundary quadrilateral");
  require_region_runs(piece);
  require(piece.layers.empty() || piece.layers.size() == static_cast<std::size_t>(piece.total_cell_count()),
          piece, "not one layer per cell");
  require(piece.shared_keys.size() == piece.shared_vertices.size(), piece, "not one key per shared vertex");
  require(std::adjacent_find(piece.shared_vertices.begin(), piece.shared_vertices.end(),
                             std::greater_equal<>()) == piece.shared_vertices.end(),
          piece, "shared vertices are not ascending");
  for (const std::vector<LocalIndex>* indices :
       {&piece.cells, &piece.boundary, &piece.shared_vertices, &piece.pyramids, &piece.prisms,
        &piece.hexahedra, &piece.quads})
    require(all_below(*indices, piece.vertex_count()), piece, "a vertex index is out of range");
}

std::int64_t bytes_at_rest(const Piece& piece) {
  const auto bytes = [](const auto& array) {
    return static_cast<std::int64_t>(array.capacity() * sizeof(array[0]));
  };
  return static_cast<std::int64_t>(sizeof(Piece)) + bytes(piece.coordinates) + bytes(piece.cells) +
         bytes(piece.vertex_dimension) + bytes(piece.vertex_entity) + bytes(piece.boundary) +
         bytes(piece.triangle_face) + bytes(piece.triangle_patch) + bytes(piece.shared_vertices) +
         bytes(piece.shared_keys) + bytes(piece.pyramids) + bytes(piece.prisms) + bytes(piece.hexahedra) +
         bytes(piece.quads) + bytes(piece.quad_face) + bytes(piece.quad_patch) + bytes(piece.runs) +
         bytes(piece.layers) + bytes(piece.surface_numbers);
}

}  // namespace aeroloom::mesh
