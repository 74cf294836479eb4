#include "pipeline/stage_log.hpp"

#include "geometry/place_text.hpp"
#include "io/file_formats.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/case/option_keys.hpp"
#include "pipeline/shown_changes.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

namespace aeroloom::pipeline {

using parallel::log_info;

void log_geometry(const cad::Model& model, const report::RunRecord& record) {
  const geometry::Vec3 size = model.body_bounds().size();
  log_info(fmt::format("geometry: {} region(s), {} faces, {} edges; body {:.6g} x {:.6g} x {:.6g} {}",
                       record.regions, record.faces, record.edges, size.x, size.y, size.z,
                       record.unit.empty() ? "(no unit declared)" : record.unit));
  if (!record.domain.reason.empty()) log_info("geometry: " + record.domain.reason);
  for (const cad::Change& change : record.domain.changes) {
    const std::string text = "geometry: " + cad::describe(change);
    change.is_warning ? parallel::log_warning(text) : log_info(text);
  }
}

void log_sizing(const report::RunRecord& record) {
  const domain::SizingFindings& findings = record.findings;
  for (const domain::JudgedEdge& edge : findings.edges)
    if (edge.fate != domain::EdgeFate::kept) log_info("sizing: " + edge.what);
  for (const std::string& line : shown_changes(findings.joined.changes, "report.json: sizing.joined_faces"))
    log_info("sizing: " + line);
  log_info(
      fmt::format("sizing: {:.4g} to {:.4g}, {:.3g} degrees per element, growth {:.3g}; {} octree leaves",
                  record.sizes.minimum, record.sizes.maximum, record.sizes.curvature_angle,
                  record.sizes.growth, record.size_field_leaves));
  if (findings.features) {
    if (const std::string text = domain::describe_share(*findings.features); !text.empty())
      log_info("sizing: " + text);
  }
  const std::string bounds = describe(findings.bounded, record.sizes);
  if (!bounds.empty() && !domain::is_much_of_body(findings.bounded)) log_info("sizing: " + bounds);
}

void warn_of_sizes(const report::RunRecord& record) {
  const domain::SizingFindings& findings = record.findings;
  if (const std::string text = describe(findings.walls.unseen); !text.empty())
    parallel::log_warning("sizing: " + text);
  if (const std::string text = findings.features ? describe(*findings.features) : std::string();
      !text.empty())
    parallel::log_warning("sizing: " + text);
  if (domain::is_much_of_body(findings.bounded))
    parallel::log_warning("sizing: " + describe(findings.bounded, record.sizes));
}

void warn_of_units(const report::RunRecord& record, const cases::OutputOptions& output) {
  if (record.unit.empty() || record.unit_in_metres == 1) return;
  for (const io::FileFormat format : output.formats) {
    const io::FormatRow& row = io::row_of(format);
    if (row.unit_warning != nullptr)
      parallel::log_warning("output: " + row.unit_warning(record.unit, record.unit_in_metres));
  }
}

namespace {

void log_closed_cusps(const report::RunRecord& record) {
  const std::vector<surface::ClosedCusp>& cusps = record.surface.closed_cusps;
  if (cusps.empty()) return;
  const auto farthest = std::max_element(
      cusps.begin(), cusps.end(),
      [](const surface::ClosedCusp& a, const surface::ClosedCusp& b) { return a.moved < b.moved; });
  log_info(fmt::format(
      "surface: {} cusp(s) of faces between tangent curves closed, by at most {:.3g} (face '{}' at {})",
      cusps.size(), farthest->moved, record.face_names.at(farthest->face),
      geometry::place_text(farthest->point)));
}

}  // namespace

void log_surface(const report::RunRecord& record) {
  log_info(
      fmt::format("surface: {} triangles in {} pieces, smallest angle {:.3g} degrees, mean ratio {:.3f} on "
                  "average",
                  record.surface.triangles, record.surface.pieces,
                  record.surface_quality->min_dihedral.minimum, record.surface_quality->mean_ratio.mean));
  log_closed_cusps(record);
}

/// Triangles below ten degrees: how many the CAD forces, and where the others are.
void log_needles(const report::RunRecord& record) {
  constexpr int shown = 5;  // lines of the log; the report has all
  std::int64_t forced = 0, forced_groups = 0, others = 0;
  double least = surface::needle_degrees;
  int listed = 0;
  std::string places;
  for (const surface::NeedleGroup& group : record.surface.needles) {
    if (group.cause != surface::NeedleCause::mesh) {
      forced += group.needles, ++forced_groups;
      least = std::min(least, group.degrees);
      continue;
    }
    others += group.needles;
    if (++listed > shown) continue;
    places += fmt::format("; {} on '{}', {:.3g} degrees at {}", group.needles,
                          record.face_names.at(group.face), group.degrees, geometry::place_text(group.at));
  }
  if (forced > 0) {
    log_info(
        fmt::format("surface: {} triangles below {:g} degrees that corners of the CAD and strips between its "
                    "curves force, in {} places, from {:.3g} degrees",
                    forced, surface::needle_degrees, forced_groups, least));
  }
  if (others > 0) {
    parallel::log_warning(fmt::format(
        "surface: before improvement {} triangles are below {:g} degrees that the CAD does not force{}{}",
        others, surface::needle_degrees, places,
        listed > shown ? "; and more, see surface.needles[] of the report" : ""));
  }
}

void log_surface_again(const std::string& reason) {
  log_info(fmt::format("surface: with joined faces and closed trailing edges: {}; again without",
                       cases::with_keys(reason)));
}

void log_layers(const report::RunRecord& record) {
  layers::PatchLayers all;
  for (const layers::PatchLayers& patch : record.layers->report.patches) {
    all.area += patch.area, all.full_area += patch.full_area, all.empty_area += patch.empty_area;
    all.prisms += patch.prisms, all.pyramids += patch.pyramids, all.tetrahedra += patch.tetrahedra;
  }
  const double area = std::max(all.area, std::numeric_limits<double>::min());
  log_info(fmt::format(
      "layers: {} prisms, {} pyramids and {} tetrahedra; {:.1f} % of the walls have all layers "
      "asked "
      "for, {:.1f} % none",
      all.prisms, all.pyramids, all.tetrahedra, 100 * all.full_area / area, 100 * all.empty_area / area));
}

void log_decompose(const report::RunRecord& record) {
  const volume::DecompositionReport& report = record.decomposition;
  log_info(fmt::format(
      "decompose: {} zone(s) for {} of {} lattice points, about {} tetrahedra from a table; heaviest "
      "zone {:.2f} of the mean",
      report.zones, report.shell_points, report.lattice_points, report.core_tetrahedra, report.imbalance));
}

void warn_of_count(const report::RunRecord& record) {
  constexpr double telling = 1.5;  // more than forecasts err by (docs/bounds.md)
  const double expected = record.decomposition.expected_tetrahedra,
               forecast = record.findings.counts.tetrahedra;
  if (expected < telling * forecast) return;
  parallel::log_warning(fmt::format(
      "decompose: about {:.2g} tetrahedra are to be made, {:.2g} times the {:.2g} that the sizes forecast{}. "
      "Remedy: larger sizes (sizing.minimum, sizing.feature_minimum)",
      expected, expected / forecast, forecast,
      record.surface.mending_rounds > 0
          ? fmt::format(": sizes fell in {} round(s) where faces or curves came too close to each other",
                        record.surface.mending_rounds)
          : ": faces have more triangles than sizes ask for"));
}

void log_volume(const report::RunRecord& record) {
  const volume::VolumeReport& report = record.volume;
  log_info(fmt::format(
      "volume: {} tetrahedra; zones knew {:.2f} times the points there are; {} round(s), {} retries, "
      "{} places where zones disagreed",
      report.tetrahedra, report.overlap, report.rounds, report.retries.size(), report.disagreements.size()));
}

void log_improve(const report::RunRecord& record) {
  const improve::ImproveReport& report = record.improve;
  log_info(fmt::format("improve: smallest dihedral angle {:.3g} -> {:.3g} degrees, {} -> {} below target",
                       report.min_angle_before, report.min_angle_after, report.bad_before, report.bad_after));
}

void log_pinned(const report::RunRecord& record) {
  const attribution::PinnedReport& report = record.pinned;
  if (report.tetrahedra + report.others == 0) return;
  const auto part = [](const attribution::MissedTarget& kind) {
    if (kind.tetrahedra == 0) return std::string("0");
    return fmt::format("{} (from {:.3g} degrees)", kind.tetrahedra, kind.smallest_angle);
  };
  log_info(fmt::format(
      "improve: of the tetrahedra below target {} are pinned by {} sharp places of the CAD, {} "
      "are at {} strips and gaps that are finer than their elements, {}{} are neither",
      part(report.pinned), report.entities.size(), part(report.at_features), report.features.size(),
      report.held.tetrahedra == 0
          ? ""
          : part(report.held) +
                " have a side or all corners on a surface or front of layers that stays as it is, ",
      part(report.rest)));
}

}  // namespace aeroloom::pipeline
