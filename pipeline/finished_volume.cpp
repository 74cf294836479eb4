#include "pipeline/finished_volume.hpp"

#include "improve/attribution/pinned.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/mixed_quality.hpp"
#include "mesh/quality/quality.hpp"
#include "pipeline/case/layer_gate.hpp"
#include "pipeline/report/exit_code.hpp"
#include "pipeline/stage_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include <fmt/format.h>

namespace aeroloom::pipeline {

namespace {

/// Tetrahedra by region, with the volumes that the check has found.
std::vector<report::RegionRow> table_of_regions(const mesh::DistributedMesh& volume,
                                                const std::vector<double>& volumes) {
  std::vector<report::RegionRow> regions;
  for (std::size_t r = 0; r < volume.regions.size(); ++r) {
    std::int64_t count = 0;
    for (const mesh::Piece& piece : volume.pieces) {
      if (static_cast<std::size_t>(piece.region) == r) count += piece.cell_count();
    }
    regions.push_back({volume.regions[r], volumes[r], volume.communicator.sum(count)});
  }
  return regions;
}

/// Collective.
bool has_layers(const mesh::DistributedMesh& volume, const mesh::MeshCounts& counts) {
  const bool here = std::any_of(volume.pieces.begin(), volume.pieces.end(),
                                [](const mesh::Piece& piece) { return !piece.layers.empty(); });
  return volume.communicator.maximum(std::int64_t{here}) > 0 || counts.has_other_shapes();
}

/// Measures that compare neighbours and edges, and what solvers make of faces. Collective.
void measure_cells(const mesh::NumberedMesh& volume, const cases::QualityGate& gate,
                   report::VolumeFigures& figures) {
  const bool all_measures = has_layers(volume, figures.counts) || gate.asks_for_cells();
  if (!all_measures && !gate.asks_for_faces()) return;
  const mesh::FaceLinks links = mesh::link_faces(volume);
  figures.solver = mesh::measure_as_solvers(volume, links);
  log_solver_quality(*figures.solver);
  if (!all_measures) return;
  figures.cells = mesh::measure_quality(volume, links);
  mesh::add_faces(*figures.solver, figures.cells->places);
}

}  // namespace

void require_valid(const std::string& what, const mesh::ValidityReport& report) {
  if (report.valid()) return;
  std::string text = what + " is not valid:";
  for (const std::string& violation : report.violations) text += "\n  " + violation;
  throw std::runtime_error(text);
}

improve::ImproveOptions improve_options(const cases::Case& input) {
  improve::ImproveOptions options = input.improve;
  options.percentiles = cases::percentile_targets(input.gate);
  if (input.layers.given) options.boundary_may_change = false;
  return options;
}

improve::ImproveReport improve_volume(const improve::ImproveOptions& options,
                                      const improve::MeshSource& source, mesh::DistributedMesh& volume,
                                      parallel::TaskStore* tasks) {
  if (!options.enabled) return {};
  improve::ImproveReport report = improve::improve_mesh(volume, options, source, tasks);
  log_improve(report);
  return report;
}

report::VolumeFigures inspect_volume(const improve::ImproveOptions& options, const cases::QualityGate& gate,
                                     const mesh::NumberedMesh& volume, const mesh::DistributedMesh* surface) {
  const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
  const mesh::ValidityReport validity = mesh::check_volume_mesh(volume, surface);
  require_valid("the volume mesh", validity);
  report::VolumeFigures figures;
  figures.mesh_volume = validity.volume;
  figures.counts = mesh::count_mesh(volume);
  figures.regions_filled = table_of_regions(volume, validity.region_volumes);
  mesh::CellsOutside suspects;
  if (options.enabled) suspects.limits = attribution::suspect_angles(options.target_angle);
  figures.quality = mesh::summarise_quality(volume, &suspects);
  measure_cells(volume, gate, figures);
  if (options.enabled) {
    figures.pinned =
        attribution::find_pinned(volume, options.target_angle, suspects, options.boundary_may_change);
    log_pinned(figures.pinned);
  }
  figures.hash = mesh::hash_mesh(volume);
  return figures;
}

void PieceArea::add(const mesh::Piece& of_piece, const mesh::LocalIndex* v) {
  const geometry::Vec3 a = of_piece.point(v[0]);
  area += 0.5 * norm(cross(of_piece.point(v[1]) - a, of_piece.point(v[2]) - a));
  ++triangles;
}

std::vector<PieceArea> gather_areas(const mesh::DistributedMesh& mesh, const std::vector<PieceArea>& mine) {
  return mesh.communicator.gather_sorted(mine,
                                         [](const PieceArea& each) { return std::tie(each.piece, each.of); });
}

std::vector<report::PatchRow> table_of_patches(const mesh::DistributedMesh& volume) {
  std::vector<PieceArea> mine;
  for (const mesh::Piece& piece : volume.pieces) {
    std::vector<PieceArea> rows;
    for (std::size_t p = 0; p < volume.patches.size(); ++p)
      rows.push_back({piece.id, static_cast<std::int32_t>(p)});
    for (mesh::LocalIndex t = 0; t < piece.boundary_count(); ++t)
      rows.at(piece.triangle_patch[t]).add(piece, piece.boundary_triangle(t));
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(mine),
                 [](const PieceArea& row) { return row.triangles > 0; });
  }
  std::vector<report::PatchRow> patches;
  for (std::size_t p = 0; p < volume.patches.size(); ++p) {
    const auto type = p < volume.patch_types.size() ? volume.patch_types[p] : mesh::PatchType::wall;
    patches.push_back({.name = volume.patches[p], .type = type, .inner = type == mesh::PatchType::interior});
  }
  for (const PieceArea& row : gather_areas(volume, mine)) {
    patches[row.of].area += row.area;
    patches[row.of].triangles += row.triangles;
  }
  return patches;
}

void add_cad_volumes(const cad::Model& model, std::vector<report::RegionRow>& regions) {
  for (cad::RegionId r = 0; r < model.region_count(); ++r)
    regions.at(static_cast<std::size_t>(r)).cad_volume = model.region_volume(r);
  for (cad::FaceId f = 0; f < model.face_count(); ++f) {
    if (model.is_far_field(f)) regions.at(static_cast<std::size_t>(model.face(f).front)).in_far_field = true;
  }
}

namespace {

/// The message about a region that does not have the volume of the CAD's.
std::string describe_missed_volume(const report::RegionRow& region, double most,
                                   const sizing::SizingOptions& sizes) {
  return fmt::format(
      "region '{}' has a volume of {:.6g}, in the CAD {:.6g}, {:.3g} of it apart, not {:g} at most; remedy: "
      "smaller sizes (sizing.minimum {:.3g} and sizing.surface_maximum {:.3g} were used)",
      region.name, region.volume, region.cad_volume, std::abs(region.volume / region.cad_volume - 1), most,
      sizes.minimum, sizes.surface_maximum);
}

/// Whether a region is so few of the smallest elements wide that these explain what it misses: the square of
/// their fraction of its breadth, as chords of arcs do.
bool is_coarse(const report::RegionRow& region, double deviation, const sizing::SizingOptions& sizes) {
  const double chord = sizes.minimum / std::cbrt(region.cad_volume);
  return deviation <= chord * chord;
}

/// The region that misses the volume of the CAD's most, among those that are coarse or among the others; a
/// far field may be coarse.
const report::RegionRow* most_missed(const cases::QualityGate& gate, const JudgedMesh& mesh, bool coarse) {
  const report::RegionRow* worst = nullptr;
  double most = gate.area_deviation;
  for (const report::RegionRow& region : mesh.volume.regions_filled) {
    if (region.in_far_field || region.cad_volume <= 0) continue;
    const double deviation = std::abs(region.volume / region.cad_volume - 1);
    if (deviation > most && is_coarse(region, deviation, mesh.sizes) == coarse)
      most = deviation, worst = &region;
  }
  return worst;
}

std::string missed_volume(const cases::QualityGate& gate, const JudgedMesh& mesh) {
  const report::RegionRow* worst = most_missed(gate, mesh, false);
  if (worst == nullptr) return {};
  return "improve.gate.area_deviation: " + describe_missed_volume(*worst, gate.area_deviation, mesh.sizes);
}

/// The message about walls that do not have the area of the CAD; empty where they have, or there is none.
std::string missed_area(const cases::QualityGate& gate, const JudgedMesh& mesh) {
  double area = 0, cad = 0, most = 0;
  const report::PatchRow* worst = nullptr;
  for (const report::PatchRow& patch : mesh.patches) {
    if (patch.type != mesh::PatchType::wall || patch.cad_area <= 0) continue;
    area += patch.area;
    cad += patch.cad_area;
    const double missing = std::abs(patch.area - patch.cad_area);
    if (missing > most) most = missing, worst = &patch;
  }
  if (worst == nullptr || std::abs(area - cad) <= gate.area_deviation * cad) return {};
  return fmt::format(
      "the mesh is not that of the body; it was written nevertheless:\n  improve.gate.area_deviation is "
      "{:.3g}, "
      "not {:g} at most: the walls have an area of {:.6g}, in the CAD {:.6g}; most is missed on '{}' ({:.6g} "
      "for {:.6g})\n  remedy: smaller sizes (sizing.minimum {:.3g} and sizing.surface_maximum {:.3g} were "
      "used); "
      "sizes are in the unit of the file, which is {}",
      std::abs(area / cad - 1), gate.area_deviation, area, cad, worst->name, worst->area, worst->cad_area,
      mesh.sizes.minimum, mesh.sizes.surface_maximum, mesh.unit);
}

std::string missed_layers(const cases::LayerGate& gate, const JudgedMesh& mesh) {
  if (mesh.layers == nullptr) return {};
  std::vector<std::string> names;
  for (const report::PatchRow& patch : mesh.patches) names.push_back(patch.name);
  return cases::missed_limits(gate, mesh.layers->asked, mesh.layers->report, names);
}

}  // namespace

std::string coarse_region(const cases::QualityGate& gate, const JudgedMesh& mesh) {
  const report::RegionRow* region = most_missed(gate, mesh, true);
  if (region == nullptr) return {};
  return describe_missed_volume(*region, gate.area_deviation, mesh.sizes) +
         "; it is a few of the smallest elements wide";
}

std::string missed_quality(const cases::Case& input, const JudgedMesh& mesh) {
  const cases::QualityGate& gate = input.gate;
  const report::VolumeFigures& volume = mesh.volume;
  std::string missed = cases::missed_limits(gate, *volume.quality, volume.pinned, volume.measured_cells());
  for (const std::string& other :
       {missed_layers(input.layers.gate, mesh), missed_area(gate, mesh), missed_volume(gate, mesh)})
    if (!other.empty()) missed += (missed.empty() ? "" : "\n") + other;
  return missed;
}

void require_quality(const cases::Case& input, const JudgedMesh& mesh) {
  const std::string missed = missed_quality(input, mesh);
  if (!missed.empty()) throw report::StageFailure("quality gate", report::ExitCode::quality_gate, missed);
}

}  // namespace aeroloom::pipeline
