#include "pipeline/finished_surface.hpp"

#include "geometry/place_text.hpp"
#include "mesh/checks/enclosures.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/data/boundary_mesh.hpp"
#include "mesh/quality/quality.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/finished_volume.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::pipeline {

namespace {

/// Areas and counts by face; sums run in the order of the pieces, whatever rank they live on.
std::vector<report::FaceRow> table_of_faces(const cad::Model& model, const mesh::DistributedMesh& surface) {
  std::vector<PieceArea> mine;
  for (const mesh::Piece& piece : surface.pieces) {
    PieceArea& row = mine.emplace_back(PieceArea{piece.id, piece.common_face()});
    for (mesh::LocalIndex t = 0; t < piece.cell_count(); ++t) row.add(piece, piece.cell(t));
  }
  std::vector<report::FaceRow> faces;
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    const cad::Face& face = model.face(f);
    faces.push_back({.name = face.name, .number = face.number, .patch = model.patches()[face.patch]});
  }
  for (const PieceArea& row : gather_areas(surface, mine)) {
    report::FaceRow& face = faces[row.of];
    if (face.triangles == 0) face.cad_area = model.face_area(row.of);
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

std::vector<mesh::PatchType> types_of(const std::vector<std::string>& patches,
                                      const cases::TypedPatches& domain) {
  const std::vector<std::string>& names = domain.model.patches();
  std::vector<mesh::PatchType> types;
  for (const std::string& patch : patches) {
    const auto found = std::find(names.begin(), names.end(), patch);
    types.push_back(domain.types.at(static_cast<std::size_t>(found - names.begin())));
  }
  return types;
}

void inspect_surface(const std::string& what, FinishedSurface& surface) {
  const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
  require_valid(what, mesh::check_surface_mesh(surface));
  report::SurfaceFigures& figures = surface.figures;
  figures.surface_quality = mesh::summarise_quality(surface);
  figures.face_table = table_of_faces(surface.model, surface);
  figures.patches = table_of_patches(surface.model, figures.face_table, surface.types);
}

void judge_chambers(const mesh::NumberedMesh& surface, cases::ChamberUse kind) {
  constexpr std::size_t most = 5;  // places that a message lists
  const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
  const std::vector<mesh::Enclosure> chambers = mesh::find_enclosures(surface);
  if (chambers.empty()) return;
  std::string places;
  for (std::size_t i = 0; i < std::min(most, chambers.size()); ++i) {
    const mesh::Enclosure& each = chambers[i];
    const std::string region =
        surface.region_count() > 1 ? fmt::format("of '{}' ", surface.regions[each.region]) : std::string();
    places += fmt::format("{}{:.4g} {}around {}", i > 0 ? ", " : "", each.volume, region,
                          geometry::place_text(each.place));
  }
  if (chambers.size() > most) places += fmt::format(" and {} more", chambers.size() - most);
  const std::string text =
      fmt::format("a region falls into {} parts that nothing joins, of volume {}", chambers.size(), places);
  if (kind == cases::ChamberUse::refuse)
    throw parallel::CollectiveError(
        parallel::FailureKind::input,
        text +
            ". Remedy: close or fill what is not wanted in the CAD, or `geometry.chambers: keep` to mesh "
            "all of them");
  if (surface.communicator.is_root()) parallel::log_warning("surface: " + text);
}

void adopt_boundary(const mesh::NumberedMesh& volume, FinishedSurface& surface) {
  static_cast<mesh::NumberedMesh&>(surface) = mesh::number_mesh(mesh::boundary_mesh(volume));
  inspect_surface("the improved surface mesh", surface);
}

}  // namespace aeroloom::pipeline
