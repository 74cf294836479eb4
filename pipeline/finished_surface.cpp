#include "pipeline/finished_surface.hpp"

#include "mesh/checks/validity.hpp"
#include "mesh/data/boundary_mesh.hpp"
#include "mesh/quality/quality.hpp"
#include "pipeline/finished_volume.hpp"

#include <tuple>

namespace aeroloom::pipeline {

using parallel::Communicator;

namespace {

/// Areas and counts by face; sums run in the order of the pieces, whatever rank they live on.
std::vector<report::FaceRow> table_of_faces(const cad::Model& model, const mesh::DistributedMesh& surface) {
  const Communicator& communicator = surface.communicator;
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
  std::vector<PieceRow> rows = communicator.gather_sorted(mine, &PieceRow::piece);
  std::vector<report::FaceRow> faces;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const cad::Face& face = model.face(f);
    faces.push_back({.name = face.name, .number = face.number, .patch = model.patches()[face.patch]});
  }
  for (const PieceRow& row : rows) {
    report::FaceRow& face = faces[row.face];
    if (face.triangles == 0) face.cad_area = model.face_area(row.face);
    face.area += row.area;
    face.triangles += row.triangles;
  }
  return faces;
}

/// The faces' sums by patch.
std::vector<report::PatchRow> table_of_patches(const cad::Model& model,
                                               const std::vector<report::FaceRow>& faces,
                                               const std::vector<mesh::PatchType>& types) {
  std::vector<report::PatchRow> patches;
  for (std::size_t p = 0; p < model.patches().size(); ++p)
    patches.push_back({.name = model.patches()[p], .type = types.at(p)});
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const report::FaceRow& face = faces[f];
    if (face.triangles == 0) continue;
    report::PatchRow& patch = patches[model.face(f).patch];
    patch.inner = patch.inner || model.face(f).back != cad::no_entity;
    patch.area += face.area;
    patch.cad_area += face.cad_area;
    patch.triangles += face.triangles;
  }
  return patches;
}

}  // namespace

void inspect_surface(const std::string& what, const FinishedSurface& surface, report::RunRecord& record) {
  const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
  require_valid(what, mesh::check_surface_mesh(surface));
  record.surface_quality = mesh::summarise_quality(surface);
  record.face_table = table_of_faces(surface.model, surface);
  record.patches = table_of_patches(surface.model, record.face_table, surface.patch_types);
}

void adopt_boundary(const mesh::NumberedMesh& volume, FinishedSurface& surface, report::RunRecord& record) {
  static_cast<mesh::NumberedMesh&>(surface) = mesh::number_mesh(mesh::boundary_mesh(volume));
  inspect_surface("the improved surface mesh", surface, record);
}

}  // namespace aeroloom::pipeline
