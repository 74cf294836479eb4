#include "pipeline/finished_volume.hpp"

#include "improve/attribution/pinned.hpp"
#include "mesh/checks/validity.hpp"
#include "mesh/quality/mixed_quality.hpp"
#include "mesh/quality/quality.hpp"
#include "pipeline/case/layer_gate.hpp"
#include "pipeline/stage_log.hpp"

#include <cmath>
#include <string>
#include <tuple>

#include <fmt/format.h>

namespace aeroloom::pipeline {

using parallel::Communicator;

namespace {

/// Tetrahedra by region, with the volumes that the check has found.
std::vector<report::RegionRow> table_of_regions(const mesh::DistributedMesh& volume,
                                                const std::vector<double>& volumes) {
  const Communicator& communicator = volume.communicator;
  std::vector<report::RegionRow> regions;
  for (std::size_t r = 0; r < volume.regions.size(); ++r) {
    std::int64_t count = 0;
    for (const mesh::Piece& piece : volume.pieces) {
      if (static_cast<std::size_t>(piece.region) == r) count += piece.cell_count();
    }
    regions.push_back({volume.regions[r], volumes[r], communicator.sum(count)});
  }
  return regions;
}

/// Tells the elements that the CAD forces from those that improvement could not mend.
void list_pinned(const cases::Case& input, const mesh::NumberedMesh& volume,
                 const mesh::CellsOutside& suspects, report::RunRecord& record) {
  record.pinned = attribution::find_pinned(volume, input.improve.target_angle, suspects,
                                           input.improve.boundary_may_change);
  log_pinned(record);
}

/// Measures that compare neighbours and edges. Collective.
mesh::MixedQuality measure_cells(const mesh::NumberedMesh& volume) {
  return mesh::measure_quality(volume, mesh::link_faces(volume));
}

}  // namespace

void require_valid(const std::string& what, const mesh::ValidityReport& report) {
  if (report.valid()) return;
  std::string text = what + " is not valid:";
  for (const std::string& violation : report.violations) text += "\n  " + violation;
  throw std::runtime_error(text);
}

improve::ImproveReport improve_volume(const cases::Case& input, const improve::MeshSource& source,
                                      mesh::DistributedMesh& volume, report::RunRecord& record,
                                      parallel::TaskStore* tasks) {
  if (!input.improve.enabled) return {};
  improve::ImproveOptions options = input.improve;
  options.percentiles = cases::percentile_targets(input.gate);
  improve::ImproveReport report = improve::improve_mesh(volume, options, source, tasks);
  record.improve = report;
  log_improve(record);
  return report;
}

mesh::MeshCounts inspect_volume(const cases::Case& input, const mesh::NumberedMesh& volume,
                                const mesh::DistributedMesh* surface, report::RunRecord& record) {
  const parallel::ScopedCpu check(parallel::ScopedCpu::As::check);
  const mesh::ValidityReport validity = mesh::check_volume_mesh(volume, surface);
  require_valid("the volume mesh", validity);
  record.mesh_volume = validity.volume;
  const mesh::MeshCounts counts = mesh::count_mesh(volume);
  record.counts = counts;
  record.regions_filled = table_of_regions(volume, validity.region_volumes);
  mesh::CellsOutside suspects;
  if (input.improve.enabled) suspects.limits = attribution::suspect_angles(input.improve.target_angle);
  record.quality = mesh::summarise_quality(volume, &suspects);
  if (input.gate.asks_for_cells()) record.cells = measure_cells(volume);
  if (input.improve.enabled) list_pinned(input, volume, suspects, record);
  record.hash = mesh::hash_mesh(volume);
  return counts;
}

std::vector<report::PatchRow> table_of_patches(const mesh::DistributedMesh& volume) {
  const Communicator& communicator = volume.communicator;
  struct PatchArea {
    mesh::PieceId piece;
    std::int32_t patch;
    double area;
    std::int64_t triangles;

    static constexpr auto fields() {
      return std::tuple(&PatchArea::piece, &PatchArea::patch, &PatchArea::area, &PatchArea::triangles);
    }
  };
  std::vector<PatchArea> mine;
  for (const mesh::Piece& piece : volume.pieces) {
    std::vector<PatchArea> rows(volume.patches.size());
    for (mesh::LocalIndex t = 0; t < piece.boundary_count(); ++t) {
      const mesh::LocalIndex* v = piece.boundary_triangle(t);
      const geometry::Vec3 a = piece.point(v[0]);
      PatchArea& row = rows.at(piece.triangle_patch[t]);
      row.area += 0.5 * norm(cross(piece.point(v[1]) - a, piece.point(v[2]) - a));
      ++row.triangles;
    }
    for (std::size_t p = 0; p < rows.size(); ++p) {
      if (rows[p].triangles > 0)
        mine.push_back({piece.id, static_cast<std::int32_t>(p), rows[p].area, rows[p].triangles});
    }
  }
  std::vector<PatchArea> rows = communicator.gather_sorted(
      mine, [](const PatchArea& each) { return std::tie(each.piece, each.patch); });
  std::vector<report::PatchRow> patches;
  for (std::size_t p = 0; p < volume.patches.size(); ++p) {
    const auto type = p < volume.patch_types.size() ? volume.patch_types[p] : mesh::PatchType::wall;
    patches.push_back({.name = volume.patches[p], .type = type, .inner = type == mesh::PatchType::interior});
  }
  for (const PatchArea& row : rows) {
    patches[row.patch].area += row.area;
    patches[row.patch].triangles += row.triangles;
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
                                   const report::RunRecord& record) {
  return fmt::format(
      "region '{}' has a volume of {:.6g}, in the CAD {:.6g}, {:.3g} of it apart, not {:g} at most; remedy: "
      "smaller sizes (sizing.minimum {:.3g} and sizing.surface_maximum {:.3g} were used)",
      region.name, region.volume, region.cad_volume, std::abs(region.volume / region.cad_volume - 1), most,
      record.sizes.minimum, record.sizes.surface_maximum);
}

/// Whether a region is so few of the smallest elements wide that these explain what it misses: the square of
/// their fraction of its breadth, as chords of arcs do.
bool is_coarse(const report::RegionRow& region, double deviation, const report::RunRecord& record) {
  const double chord = record.sizes.minimum / std::cbrt(region.cad_volume);
  return deviation <= chord * chord;
}

/// The region that misses the volume of the CAD's most, among those that are coarse or among the others; a
/// far field may be coarse.
const report::RegionRow* most_missed(const cases::QualityGate& gate, const report::RunRecord& record,
                                     bool coarse) {
  const report::RegionRow* worst = nullptr;
  double most = gate.area_deviation;
  for (const report::RegionRow& region : record.regions_filled) {
    if (region.in_far_field || region.cad_volume <= 0) continue;
    const double deviation = std::abs(region.volume / region.cad_volume - 1);
    if (deviation > most && is_coarse(region, deviation, record) == coarse) most = deviation, worst = &region;
  }
  return worst;
}

std::string missed_volume(const cases::QualityGate& gate, const report::RunRecord& record) {
  const report::RegionRow* worst = most_missed(gate, record, false);
  if (worst == nullptr) return {};
  return "improve.gate.area_deviation: " + describe_missed_volume(*worst, gate.area_deviation, record);
}

/// The message about walls that do not have the area of the CAD; empty where they have, or there is none.
std::string missed_area(const cases::QualityGate& gate, const report::RunRecord& record) {
  double area = 0, cad = 0, most = 0;
  const report::PatchRow* worst = nullptr;
  for (const report::PatchRow& patch : record.patches) {
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
      record.sizes.minimum, record.sizes.surface_maximum, record.unit);
}

std::string missed_layers(const cases::LayerGate& gate, const report::RunRecord& record) {
  if (!record.layers) return {};
  std::vector<std::string> names;
  for (const report::PatchRow& patch : record.patches) names.push_back(patch.name);
  return cases::missed_limits(gate, record.layers->asked, record.layers->report, names);
}

}  // namespace

std::string coarse_region(const cases::QualityGate& gate, const report::RunRecord& record) {
  const report::RegionRow* region = most_missed(gate, record, true);
  if (region == nullptr) return {};
  return describe_missed_volume(*region, gate.area_deviation, record) +
         "; it is a few of the smallest elements wide";
}

void require_quality(const cases::Case& input, const report::RunRecord& record) {
  const cases::QualityGate& gate = input.gate;
  std::string missed =
      cases::missed_limits(gate, *record.quality, record.pinned, record.cells ? &*record.cells : nullptr);
  for (const std::string& other :
       {missed_layers(input.layers.gate, record), missed_area(gate, record), missed_volume(gate, record)})
    if (!other.empty()) missed += (missed.empty() ? "" : "\n") + other;
  if (!missed.empty()) throw report::StageFailure("quality gate", report::ExitCode::quality_gate, missed);
}

}  // namespace aeroloom::pipeline
