#include "pipeline/stage_log.hpp"

#include "geometry/place_text.hpp"
#include "geometry/shown_list.hpp"
#include "io/file_formats.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/case/layer_gate.hpp"
#include "pipeline/case/option_keys.hpp"
#include "pipeline/report/places_json.hpp"
#include "pipeline/report/solver_quality_text.hpp"
#include "pipeline/shown_changes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>

#include <fmt/format.h>

namespace aeroloom::pipeline {

using parallel::log_info;

void log_geometry(const cad::Model& model, const cad::DomainReport& report) {
  const geometry::Vec3 size = model.body_bounds().size();
  log_info(fmt::format("geometry: {} region(s), {} faces, {} edges; body {:.6g} x {:.6g} x {:.6g} {}",
                       model.region_count(), model.face_count(), model.edge_count(), size.x, size.y, size.z,
                       model.unit_name().empty() ? "(no unit declared)" : model.unit_name()));
  if (!report.reason.empty()) log_info("geometry: " + report.reason);
  for (const cad::Change& change : report.changes) {
    const std::string text = "geometry: " + cad::describe(change);
    change.is_warning ? parallel::log_warning(text) : log_info(text);
  }
}

void log_sizing(const domain::SizedDomain& sized) {
  const domain::SizingFindings& findings = sized.findings;
  log_info("sizing: far field: " + findings.far_field);
  for (const domain::JudgedEdge& edge : findings.edges)
    if (edge.fate != domain::EdgeFate::kept) log_info("sizing: " + edge.what);
  for (const std::string& line : shown_changes(findings.joined.changes, "report.json: sizing.joined_faces"))
    log_info("sizing: " + line);
  log_info(
      fmt::format("sizing: {:.4g} to {:.4g}, {:.3g} degrees per element, growth {:.3g}; {} octree leaves",
                  sized.sizes.minimum, sized.sizes.maximum, sized.sizes.curvature_angle, sized.sizes.growth,
                  sized.field.leaf_count()));
  if (findings.features) {
    if (const std::string text = domain::describe_added(*findings.features); !text.empty())
      log_info("sizing: " + text);
  }
  const std::string bounds = describe(findings.bounded, sized.sizes);
  if (!bounds.empty()) log_info("sizing: " + bounds);
}

void warn_of_sizes(const domain::SizedDomain& sized) {
  const domain::SizingFindings& findings = sized.findings;
  if (const std::string& text = findings.missed_target; !text.empty())
    parallel::log_warning("sizing: " + text);
  if (const std::string text = describe(findings.walls.unseen); !text.empty())
    parallel::log_warning("sizing: " + text);
  if (const std::string text = findings.features ? describe(*findings.features) : std::string();
      !text.empty())
    parallel::log_warning("sizing: " + text);
  if (const std::string text = warning_of(findings.bounded, sized.sizes); !text.empty())
    parallel::log_warning("sizing: " + text);
}

void warn_of_units(const std::string& unit, double metres, const cases::OutputOptions& output) {
  if (unit.empty() || metres == 1) return;
  std::string formats, command;
  for (const io::FileFormat format : output.formats) {
    const io::FormatRow& row = io::row_of(format);
    if (!row.in_metres) continue;
    formats += fmt::format("{}{}", formats.empty() ? "" : ", ", row.name);
    if (row.scaling != nullptr) command = fmt::format(" ({}: {})", row.name, row.scaling(metres));
  }
  if (formats.empty()) return;
  parallel::log_warning(fmt::format(
      "output: lengths stay in {}, and solvers take those of {} for metres. Remedy: scale the mesh by {:g} "
      "before a solver reads it{}",
      unit, formats, metres, command));
}

void warn_of_solver_points(const cases::Case& input) {
  if (!input.layers.given || !input.layers.reynolds || input.sizing.solver != sizing::SolverPoints::vertex)
    return;
  for (const io::FileFormat format : input.output.formats) {
    const io::FormatRow& row = io::row_of(format);
    if (!row.cell_centred) continue;
    parallel::log_warning(fmt::format(
        "layers: y+ is that of the first node, but solvers that read {} have it at the first cell's centre, "
        "where it is half of that. Remedy: sizing.solver: cell",
        row.name));
  }
}

void warn_of_case(const cases::TypedPatches& patches, const cases::Case& input) {
  warn_of_units(patches.model.unit_name(), patches.model.unit_in_metres(), input.output);
  warn_of_solver_points(input);
  for (const std::string& warning : patches.warnings) parallel::log_warning(warning);
}

namespace {

void log_closed_cusps(const std::vector<surface::ClosedCusp>& cusps,
                      const std::vector<report::FaceRow>& faces) {
  if (cusps.empty()) return;
  const auto farthest = std::max_element(
      cusps.begin(), cusps.end(),
      [](const surface::ClosedCusp& a, const surface::ClosedCusp& b) { return a.moved < b.moved; });
  log_info(fmt::format(
      "surface: {} cusp(s) of faces between tangent curves closed, by at most {:.3g} (face '{}' at {})",
      cusps.size(), farthest->moved, faces.at(farthest->face).name, geometry::place_text(farthest->point)));
}

void log_rows(const std::vector<surface::RowsMade>& all) {
  constexpr double few = 0.8;  // of the length; chosen, not measured
  if (all.empty()) return;
  double length = 0, with_rows = 0, stretched = 0;
  int most = 0;
  for (const surface::RowsMade& rows : all) {
    length += rows.length, with_rows += rows.with_rows, stretched += rows.stretched;
    most = std::max(most, rows.most);
  }
  log_info(
      fmt::format("surface: rows along {:.1f} % of {} edge(s), at least four times as long as high on {:.1f} "
                  "%, up to {} rows",
                  100 * with_rows / length, all.size(), 100 * stretched / length, most));
  if (with_rows >= few * length) return;
  const auto missing = [](const surface::RowsMade& rows) { return rows.length - rows.with_rows; };
  const auto worst = std::max_element(all.begin(), all.end(),
                                      [&](const auto& a, const auto& b) { return missing(a) < missing(b); });
  parallel::log_warning(
      fmt::format("surface: rows along {:.1f} % of the length of {} edge(s) that 'sizing.edges' asks for; "
                  "most is missing on CAD edge "
                  "{}, {:.4g} of {:.4g}. Segments there are too short for rows, by curvature, gaps or other "
                  "sizes, or the edge is a "
                  "seam or of facets. Remedy: a smaller 'height', larger sizes there ('sizing.minimum', "
                  "'sizing.curvature_angle'), or "
                  "'size' in place of 'height'",
                  100 * with_rows / length, all.size(), worst->edge, missing(*worst), worst->length));
}

}  // namespace

void log_surface(const surface::SurfaceReport& report, const report::SurfaceFigures& figures) {
  log_info(
      fmt::format("surface: {} triangles in {} pieces, smallest angle {:.3g} degrees, mean ratio {:.3f} on "
                  "average",
                  report.triangles, report.pieces, figures.surface_quality->min_dihedral.minimum,
                  figures.surface_quality->mean_ratio.mean));
  log_closed_cusps(report.closed_cusps, figures.face_table);
  log_rows(report.rows);
}

void log_needles(const surface::SurfaceReport& report, const std::vector<report::FaceRow>& faces) {
  std::int64_t forced = 0, forced_groups = 0, others = 0;
  double least = surface::needle_degrees;
  int places = 0;
  const surface::NeedleGroup* worst = nullptr;
  for (const surface::NeedleGroup& group : report.needles) {
    if (group.cause != surface::NeedleCause::mesh) {
      forced += group.needles, ++forced_groups;
      least = std::min(least, group.degrees);
      continue;
    }
    others += group.needles;
    ++places;
    if (worst == nullptr || group.degrees < worst->degrees) worst = &group;
  }
  if (forced > 0) {
    log_info(fmt::format(
        "surface: {} triangles below {:g} degrees that corners of the CAD and narrow regions between its "
        "curves force, in {} places, from {:.3g} degrees",
        forced, surface::needle_degrees, forced_groups, least));
  }
  if (others > 0) {
    parallel::log_warning(
        fmt::format("surface: before improvement {} triangles in {} place(s) are below {:g} degrees that the "
                    "CAD does not "
                    "force, the least {:.3g} on '{}' at {}. Remedy: smaller sizes there (surface.needles[] "
                    "of the report)",
                    others, places, surface::needle_degrees, worst->degrees, faces.at(worst->face).name,
                    geometry::place_text(worst->at)));
  }
}

void warn_of_lost_area(const std::vector<report::PatchRow>& patches) {
  constexpr double told = 0.02;  // of the area
  std::vector<const report::PatchRow*> lost;
  for (const report::PatchRow& patch : patches)
    if (patch.type == mesh::PatchType::wall && std::abs(patch.area - patch.cad_area) > told * patch.cad_area)
      lost.push_back(&patch);
  if (lost.empty()) return;
  const auto missing = [](const report::PatchRow* patch) { return std::abs(patch->area - patch->cad_area); };
  std::ranges::stable_sort(lost, std::ranges::greater(), missing);
  const std::string names = geometry::shown_list(lost, [](const report::PatchRow* patch) {
    return fmt::format("'{}' ({:.3g} %)", patch->name, 100 * (patch->area / patch->cad_area - 1));
  });
  parallel::log_warning(fmt::format(
      "surface: the area of {} differs from the CAD's by more than {:g} %: holes, fillets or edges there are "
      "coarse. Remedy: a smaller sizing.minimum or sizing.curvature_angle, or patches.NAME.size",
      names, 100 * told));
}

void log_surface_again(const std::string& reason) {
  log_info(fmt::format("surface: with joined faces and closed trailing edges: {}; again without",
                       cases::with_keys(reason)));
}

void log_layers(const report::LayerRecord& record) {
  layers::PatchLayers all;
  for (const layers::PatchLayers& patch : record.report.patches) {
    all.area += patch.area, all.full_area += patch.full_area, all.empty_area += patch.empty_area;
    all.low_first_area += patch.low_first_area, all.sums.heights += patch.sums.heights;
    all.sums.layers += patch.sums.layers, all.sums.wanted += patch.sums.wanted;
    all.prisms += patch.prisms, all.pyramids += patch.pyramids, all.tetrahedra += patch.tetrahedra;
    all.hexahedra += patch.hexahedra;
  }
  const double area = std::max(all.area, std::numeric_limits<double>::min());
  log_info(fmt::format(
      "layers: {} prisms, {}{} pyramids and {} tetrahedra; {:.1f} % of the walls have all layers asked for, "
      "{:.1f} % none; on {:.1f} % the first is lower than {:g} of what is asked for",
      all.prisms, all.hexahedra > 0 ? fmt::format("{} hexahedra, ", all.hexahedra) : "", all.pyramids,
      all.tetrahedra, 100 * all.full_area / area, 100 * all.empty_area / area,
      100 * all.low_first_area / area, layers::PatchLayers::low));
  const std::string plate =
      record.boundary_layer
          ? fmt::format("; the boundary layer of a flat plate is {:.3g}", *record.boundary_layer)
          : "";
  log_info(fmt::format("layers: on average {:.1f} of {:.1f}, together {:.3g} high{}", all.sums.layers / area,
                       all.sums.wanted / area, all.sums.heights / area, plate));
}

void warn_of_missing_layers(const report::LayerRecord& layers, const std::vector<std::string>& patches) {
  const std::string text = cases::missing_layers(layers.asked, layers.report, patches);
  if (!text.empty()) parallel::log_warning("layers: " + text);
}

namespace {

/// That the layers of a patch are lower than the boundary layer; else empty.
std::string below_boundary_layer(const std::optional<double>& thickness, const layers::PatchLayers& made) {
  constexpr double wanted = 1.2;
  const double height = made.sums.heights / made.area;
  if (!thickness || height >= wanted * *thickness) return {};
  return fmt::format("layers are {:.3g} high on average, where a boundary layer on a flat plate is {:.3g}",
                     height, *thickness);
}

/// Of layers that end early, and that this has not mended.
std::string_view remedy_after(cases::LayerFit fit) {
  if (fit == cases::LayerFit::none)
    return "layers.fit: growth or count, a larger layers.count or layers.total, or neither";
  if (fit == cases::LayerFit::growth)
    return "layers.fit: count, or a larger layers.growth_maximum or layers.count";
  return "a growth above 1, or a larger layers.count or layers.total";
}

}  // namespace

void warn_of_low_layers(const report::LayerRecord& layers, const std::vector<std::string>& patches) {
  for (std::size_t p = 0; p < layers.report.patches.size(); ++p) {
    const layers::PatchLayers& made = layers.report.patches[p];
    if (made.area <= 0) continue;
    const std::string early = cases::early_end(layers.asked.patches.at(p), made.sums.edges / made.area);
    if (!early.empty())
      parallel::log_warning(
          fmt::format("layers: on '{}' {}. Remedy: {}", patches.at(p), early, remedy_after(layers.fit)));
    const std::string low = below_boundary_layer(layers.boundary_layer, made);
    if (!low.empty())
      parallel::log_warning(fmt::format(
          "layers: on '{}' {}. Remedy: more layers (layers.count, layers.total), or larger sizes on the wall",
          patches.at(p), low));
  }
}

void log_decompose(const volume::DecompositionReport& report) {
  log_info(fmt::format(
      "decompose: {} zone(s) for {} of {} lattice points, about {} tetrahedra from a table; heaviest "
      "zone {:.2f} of the mean",
      report.zones, report.shell_points, report.lattice_points, report.core_tetrahedra, report.imbalance));
}

void warn_of_count(double expected, double forecast, int resize_rounds) {
  constexpr double least_warned_ratio = 1.5;  // more than forecasts err by (docs/bounds.md)
  if (expected < least_warned_ratio * forecast) return;
  parallel::log_warning(fmt::format(
      "decompose: about {:.2g} tetrahedra are to be made, {:.2g} times the {:.2g} that the sizes forecast{}. "
      "Remedy: larger sizes (sizing.minimum, sizing.feature_minimum)",
      expected, expected / forecast, forecast,
      resize_rounds > 0
          ? fmt::format(": sizes fell in {} round(s) where faces or curves came too close to each other",
                        resize_rounds)
          : ": faces have more triangles than sizes ask for"));
}

void log_volume(const volume::VolumeReport& report) {
  log_info(fmt::format(
      "volume: {} tetrahedra; zones knew {:.2f} times the points there are; {} round(s), {} retries, "
      "{} places where zones disagreed",
      report.tetrahedra, report.overlap, report.rounds, report.retries.size(), report.disagreements.size()));
}

void log_improve(const improve::ImproveReport& report) {
  log_info(fmt::format("improve: smallest dihedral angle {:.3g} -> {:.3g} degrees, {} -> {} below target",
                       report.min_angle_before, report.min_angle_after, report.bad_before, report.bad_after));
}

void log_solver_quality(const mesh::SolverQuality& quality) {
  for (const std::string& line : report::solver_lines(quality))
    log_info("quality, as solvers judge: " + line);
}

namespace {

const char* remedy_of(mesh::Flaw flaw) {
  switch (flaw) {
    case mesh::Flaw::small_angle:
      return "smaller sizes there, or other CAD where its angles force it";
    case mesh::Flaw::bad_shape:
      return "fewer or lower layers there (layers.patches), or smaller sizes";
    case mesh::Flaw::non_orthogonality:
    case mesh::Flaw::skewness:
      return "smaller sizes there, or fewer or lower layers beside it (layers.patches)";
    case mesh::Flaw::size_jump:
      break;
  }
  return "smaller sizes there, or more layers (layers.count, layers.total)";
}

}  // namespace

void warn_of_flaws(const report::VolumeFigures& figures) {
  for (const mesh::FlawedCell& place : report::worst_flaws(figures)) {
    if (mesh::verdict_of(place.severity) != mesh::Verdict::poor) continue;
    parallel::log_warning(fmt::format("quality: the mesh has {}. Remedy: {}", report::text_of_place(place),
                                      remedy_of(place.flaw)));
  }
}

void log_pinned(const attribution::PinnedReport& report) {
  if (report.tetrahedra + report.others == 0) return;
  const auto part = [](const attribution::MissedTarget& kind) {
    if (kind.tetrahedra == 0) return std::string("0");
    return fmt::format("{} (from {:.3g} degrees)", kind.tetrahedra, kind.smallest_angle);
  };
  log_info(fmt::format(
      "improve: of the tetrahedra below target {} are pinned by {} sharp places of the CAD, {} "
      "are at {} narrow regions and gaps that are finer than their elements, {}{}{} are neither",
      part(report.pinned), report.entities.size(), part(report.at_features), report.features.size(),
      report.held.tetrahedra == 0
          ? ""
          : part(report.held) +
                " have a side or all corners on a surface or front of layers that stays as it is, ",
      report.beside.tetrahedra == 0 ? "" : part(report.beside) + " have a corner in common with such ones, ",
      part(report.rest)));
}

}  // namespace aeroloom::pipeline
