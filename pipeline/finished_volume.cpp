#include "pipeline/finished_volume.hpp"

#include "improve/pinned.hpp"
#include "mesh/quality.hpp"
#include "mesh/validity.hpp"
#include "parallel/log.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace aeroloom::pipeline {

using parallel::Communicator;

namespace {

/// Tetrahedra and volume by region; sums run in the order of the pieces.
std::vector<RegionRow> table_of_regions(const Communicator& communicator,
                                        const mesh::DistributedMesh& volume) {
  struct PieceRow {
    mesh::PieceId piece;
    std::int32_t region;
    std::int64_t tetrahedra;
    double volume;
  };
  std::vector<PieceRow> mine;
  for (const mesh::Piece& piece : volume.pieces) {
    double sum = 0;
    for (mesh::LocalIndex c = 0; c < piece.cell_count(); ++c) {
      const mesh::LocalIndex* v = piece.cell(c);
      sum +=
          geometry::volume6(piece.point(v[0]), piece.point(v[1]), piece.point(v[2]), piece.point(v[3])) / 6;
    }
    mine.push_back({piece.id, piece.region, piece.cell_count(), sum});
  }
  std::vector<PieceRow> rows = communicator.all_gather_items<PieceRow>(mine);
  std::sort(rows.begin(), rows.end(), [](const PieceRow& a, const PieceRow& b) { return a.piece < b.piece; });
  std::vector<RegionRow> regions;
  for (const std::string& name : volume.regions) regions.push_back({.name = name});
  for (const PieceRow& row : rows) {
    regions[row.region].tetrahedra += row.tetrahedra;
    regions[row.region].volume += row.volume;
  }
  return regions;
}

/// Tells the elements that the CAD forces from those that improvement could not mend.
void list_pinned(const Communicator& communicator, const Case& input, const mesh::DistributedMesh& volume,
                 const mesh::Numbering& numbering, RunRecord& record) {
  record.pinned = improve::find_pinned(communicator, volume, numbering, input.improve.target_angle);
  if (record.pinned.entities.empty()) return;
  parallel::log_info(
      fmt::format("improve: {} of the tetrahedra below target are pinned by {} sharp places of the CAD",
                  record.pinned.tetrahedra, record.pinned.entities.size()));
}

}  // namespace

double require_valid(const std::string& what, const mesh::ValidityReport& report) {
  if (report.valid()) return report.volume;
  std::string text = what + " is not valid:";
  for (const std::string& violation : report.violations) text += "\n  " + violation;
  throw std::runtime_error(text);
}

void improve_volume(const Communicator& communicator, const Case& input, const improve::MeshSource& source,
                    mesh::DistributedMesh& volume, RunRecord& record) {
  if (!input.improve.enabled) return;
  record.improve = improve::improve_mesh(communicator, volume, input.improve, record.clock, source);
  parallel::log_info(
      fmt::format("improve: smallest dihedral angle {:.3g} -> {:.3g} degrees, {} -> {} below target",
                  record.improve.min_angle_before, record.improve.min_angle_after, record.improve.bad_before,
                  record.improve.bad_after));
}

void inspect_volume(const Communicator& communicator, const Case& input, const mesh::DistributedMesh& volume,
                    const mesh::Numbering& numbering, const mesh::DistributedMesh* surface,
                    RunRecord& record) {
  const parallel::ScopedCpu check(record.clock, parallel::ScopedCpu::As::check);
  record.mesh_volume =
      require_valid("the volume mesh", mesh::check_volume_mesh(communicator, volume, numbering, surface));
  record.counts = mesh::count_mesh(communicator, volume, numbering);
  record.regions_filled = table_of_regions(communicator, volume);
  record.quality = mesh::summarise_quality(communicator, volume, numbering);
  if (input.improve.enabled) list_pinned(communicator, input, volume, numbering, record);
  record.hash = mesh::hash_mesh(communicator, volume, numbering);
}

void require_quality(const QualityGate& gate, const RunRecord& record) {
  const std::string missed = missed_limits(gate, *record.quality, record.pinned);
  if (!missed.empty()) throw StageFailure("quality gate", ExitCode::quality_gate, missed);
}

}  // namespace aeroloom::pipeline
