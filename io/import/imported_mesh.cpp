#include "io/import/imported_mesh.hpp"

#include "io/doubled_nodes.hpp"
#include "io/read_mesh.hpp"
#include "mesh/data/piece_faces.hpp"
#include "mesh/exchange/shared_vertices.hpp"
#include "mesh/transfer/piece_size.hpp"
#include "mesh/transfer/repartition.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace aeroloom::imported {
namespace {

using mesh::GlobalIndex;
using mesh::LocalIndex;

/// Vertices of boundary faces lie on the largest CAD face around them, in whatever piece that is; others in
/// the region of their piece. Collective.
void classify_vertices(mesh::DistributedMesh& mesh) {
  constexpr std::int32_t none = -1;
  for (mesh::Piece& piece : mesh.pieces) {
    piece.vertex_entity.assign(piece.vertex_count(), none);
    for (LocalIndex f = 0; f < mesh::boundary_face_count(piece); ++f) {
      for (const LocalIndex v : mesh::corners_of_boundary(piece, f))
        piece.vertex_entity[v] = std::max(piece.vertex_entity[v], mesh::cad_face_of(piece, f));
    }
  }
  const mesh::SharedVertices shared(mesh);
  std::vector<std::int32_t> faces(shared.size());
  shared.for_each(
      [&](std::size_t p, LocalIndex v, std::size_t copy) { faces[copy] = mesh.pieces[p].vertex_entity[v]; });
  shared.reduce_and_scatter(faces, [](std::int32_t a, std::int32_t b) { return std::max(a, b); });
  shared.for_each(
      [&](std::size_t p, LocalIndex v, std::size_t copy) { mesh.pieces[p].vertex_entity[v] = faces[copy]; });
  for (mesh::Piece& piece : mesh.pieces) {
    piece.vertex_dimension.assign(piece.vertex_count(), mesh::CadDimension::face);
    for (LocalIndex v = 0; v < piece.vertex_count(); ++v) {
      if (piece.vertex_entity[v] != none) continue;
      piece.vertex_dimension[v] = mesh::CadDimension::region;
      piece.vertex_entity[v] = piece.region;
    }
  }
}

}  // namespace

mesh::DistributedMesh pieces_of(const io::FileMesh& mesh, const std::string& path,
                                std::optional<std::int64_t> piece_tets) {
  const GlobalIndex tets = mesh.cell_count(io::CellShape::tetrahedron), others = mesh.cell_count() - tets;
  if (others > 0) {
    throw parallel::CollectiveError(
        parallel::FailureKind::input,
        fmt::format("'{}' has {} pyramids, prisms and hexahedra beside {} tetrahedra. Remedy: give a mesh of "
                    "tetrahedra alone; "
                    "`aeroloom convert` and `aeroloom quality` take the others too",
                    path, others, tets));
  }
  const std::int64_t size = piece_tets.value_or(partition::suitable_piece_tets(static_cast<double>(tets)));
  const bool one = 2 * tets <= 3 * size;
  mesh::DistributedMesh result = mesh::repartition(
      *mesh.pieces, one ? 1 : static_cast<mesh::PieceId>((tets + size / 2) / size), mesh::PieceRegions::one);
  classify_vertices(result);
  return result;
}

mesh::DistributedMesh import_mesh(const io::SharedPath& file, std::optional<std::int64_t> piece_tets) {
  const io::Assembled read = io::read_mesh(file, 0);
  if (file.communicator.is_root()) {
    parallel::log_info(fmt::format("input: {} tetrahedra, {} points, {} region(s), {} patch(es); {}",
                                   read.mesh.cell_count(), read.mesh.vertex_count, read.mesh.regions.size(),
                                   read.mesh.patches.size(), io::describe(read)));
  }
  const io::DoubledNodes doubled = io::find_doubled_nodes(read.mesh);
  if (doubled.nodes > 0 && file.communicator.is_root())
    parallel::log_warning(fmt::format("input: {}", io::describe(doubled)));
  return pieces_of(read.mesh, file.path, piece_tets);
}

}  // namespace aeroloom::imported
