#include "pipeline/finished_surface.hpp"

#include "aeroloom/mesh/quality.hpp"
#include "aeroloom/mesh/validity.hpp"
#include "mesh/boundary_mesh.hpp"
#include "pipeline/finished_volume.hpp"

#include <algorithm>
#include <tuple>

namespace aeroloom::pipeline {

using parallel::Communicator;

namespace {

/// Areas and counts by patch; sums run in the order of the pieces, whatever rank they live on.
std::vector<report::PatchRow> table_of_patches(const Communicator& communicator, const cad::Model& model,
                                               const mesh::DistributedMesh& surface,
                                               const std::vector<mesh::PatchType>& types) {
  struct PieceRow {
    mesh::PieceId piece;
    cad::FaceId face;
    double area;
    std::int64_t triangles;

    static constexpr auto fields() {
      return std::tuple(&PieceRow::piece, &PieceRow::face, &PieceRow::area, &PieceRow::triangles);
    }
  };
  std::vector<PieceRow> mine;
  for (const mesh::Piece& piece : surface.pieces) {
    double area = 0;
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) {
      const mesh::LocalIndex* v = piece.cell(t);
      const geometry::Vec3 a = piece.point(v[0]);
      area += 0.5 * norm(cross(piece.point(v[1]) - a, piece.point(v[2]) - a));
    }
    mine.push_back({piece.id, piece.common_face(), area, piece.cell_count()});
  }
  std::vector<PieceRow> rows = communicator.all_gather_items<PieceRow>(mine);
  std::sort(rows.begin(), rows.end(), [](const PieceRow& a, const PieceRow& b) { return a.piece < b.piece; });
  std::vector<report::PatchRow> patches;
  for (std::size_t p = 0; p < model.patches().size(); ++p)
    patches.push_back({.name = model.patches()[p], .type = types.at(p)});
  std::vector<char> counted(model.face_count(), 0);
  for (const PieceRow& row : rows) {
    report::PatchRow& patch = patches[model.face(row.face).patch];
    patch.inner = patch.inner || model.face(row.face).back != cad::no_entity;
    patch.area += row.area;
    patch.triangles += row.triangles;
    if (!counted[row.face]) patch.cad_area += model.face_area(row.face);
    counted[row.face] = 1;
  }
  return patches;
}

}  // namespace

void inspect_surface(const Communicator& communicator, const cad::Model& model, const std::string& what,
                     const mesh::NumberedMesh& surface, report::RunRecord& record) {
  const parallel::ScopedCpu check(record.clock, parallel::ScopedCpu::As::check);
  require_valid(what, mesh::check_surface_mesh(communicator, surface.mesh, surface.numbering));
  record.surface_quality = mesh::summarise_quality(communicator, surface.mesh, surface.numbering);
  record.patches = table_of_patches(communicator, model, surface.mesh, record.patch_types);
}

void adopt_boundary(const Communicator& communicator, const cad::Model& model,
                    const mesh::DistributedMesh& volume, const mesh::Numbering& numbering,
                    FinishedSurface& surface, report::RunRecord& record) {
  surface.mesh = mesh::boundary_mesh(communicator, volume, numbering);
  surface.numbering = mesh::number_mesh(communicator, surface.mesh);
  inspect_surface(communicator, model, "the improved surface mesh", surface, record);
}

}  // namespace aeroloom::pipeline
