#include "pipeline/report/text_table.hpp"

#include "pipeline/report/places_json.hpp"

#include <fmt/format.h>

namespace aeroloom::report {
namespace {

/// Cells that are no tetrahedra, by shape; those of layers are prisms and pyramids always.
std::string other_cells_text(const mesh::MeshCounts& counts) {
  if (!counts.has_other_shapes()) return "";
  std::string text = fmt::format("{} prisms, {} pyramids, ", counts.prisms, counts.pyramids);
  if (counts.hexahedra > 0) text += fmt::format("{} hexahedra, ", counts.hexahedra);
  return text;
}

}  // namespace

std::string report_table(const RunRecord& record, const std::vector<parallel::StageSummary>& stages,
                         int ranks) {
  std::string text = fmt::format("{:<10} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>11} {:>8}\n",
                                 "stage", "wall s", "cpu min", "cpu mean", "cpu max", "checks", "other",
                                 "waiting", "pieces", "memory MiB", "own MiB");
  for (const parallel::StageSummary& s : stages) {
    text += fmt::format(
        "{:<10} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>9.2f} {:>8} {:>11.0f} {:>8.0f}\n",
        s.name, s.wall_seconds, s.cpu_seconds_min, s.cpu_seconds_mean, s.cpu_seconds_max, s.check_seconds,
        s.other_seconds, s.waiting_seconds_mean, s.pieces, double(s.peak_resident_bytes_max) / (1 << 20),
        double(s.peak_own_bytes_max) / (1 << 20));
  }
  text += fmt::format("{:<10} {:>9.2f}  on {} rank(s)\n", "total", record.wall_seconds, ranks);
  if (!record.quality) return text;
  const bool layered = record.counts.has_other_shapes();
  text += fmt::format(
      "mesh: {} tetrahedra, {}{} points, {} boundary triangles, volume {:.10g}\n"
      "quality{}: dihedral angles {:.2f} to {:.2f} degrees, mean ratio {:.3f} at least, {:.3f} on average\n"
      "hash: {}\n",
      record.counts.of(mesh::CellShape::tetrahedron), other_cells_text(record.counts), record.counts.vertices,
      record.counts.boundary_triangles, record.mesh_volume, layered ? " off the layers" : "",
      record.quality->min_dihedral.minimum, record.quality->max_dihedral.maximum,
      record.quality->mean_ratio.minimum, record.quality->mean_ratio.mean, record.hash);
  for (const mesh::FlawedCell& place : worst_flaws(record))
    if (place.flaw != mesh::Flaw::small_angle)
      text += fmt::format("worst: {}, {}\n", text_of_place(place),
                          mesh::name_of(mesh::verdict_of(place.severity)));
  text +=
      fmt::format("{:<28} {:<9} {:>10} {:>14} {:>14}\n", "patch", "type", "triangles", "area", "CAD area");
  for (const PatchRow& p : record.patches) {
    // A mesh from a file has none.
    const std::string cad = p.cad_area > 0 ? fmt::format("{:.8g}", p.cad_area) : "-";
    text += fmt::format("{:<28} {:<9} {:>10} {:>14.8g} {:>14}\n", p.name, mesh::name_of(p.type), p.triangles,
                        p.area, cad);
  }
  return text;
}

}  // namespace aeroloom::report
