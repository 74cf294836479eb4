#include "pipeline/report.hpp"

#include "pipeline/change_json.hpp"
#include "pipeline/mixed_quality_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {
namespace {

using Json = nlohmann::ordered_json;

constexpr int schema_version = 2;

Json geometry_json(const RunRecord& record) {
  Json json;
  json["unit"] = record.unit;
  json["unit_in_metres"] = record.unit_in_metres;
  if (!record.bounds.empty()) json["bounds"] = {to_json(record.bounds.low), to_json(record.bounds.high)};
  json["regions"] = record.regions;
  json["faces"] = record.faces;
  json["edges"] = record.edges;
  json["domain"] = record.domain.kind == cad::DomainKind::fluid  ? "fluid"
                   : record.domain.kind == cad::DomainKind::body ? "body"
                                                                 : "auto";
  json["domain_reason"] = record.domain.reason;
  json["reference_length"] = record.domain.reference_length;
  json["changes"] = to_json(record.domain.changes);
  return json;
}

Json sizing_json(const RunRecord& record) {
  return {{"features", record.features ? to_json(*record.features) : Json()},
          {"minimum", record.sizes.minimum},
          {"feature_minimum", sizing::smallest_feature_size(record.sizes)},
          {"strip_minimum", sizing::smallest_strip_size(record.sizes)},
          {"gap_minimum", sizing::smallest_gap_size(record.sizes)},
          {"maximum", record.sizes.maximum},
          {"surface_maximum", record.sizes.surface_maximum},
          {"curvature_angle", record.sizes.curvature_angle},
          {"chordal_deviation", record.sizes.chordal_deviation},
          {"growth", record.sizes.growth},
          {"joined_faces", to_json(record.joined_faces)},
          {"octree_leaves", record.size_field_leaves}};
}

Json mesh_json(const RunRecord& record) {
  return {{"points", record.counts.vertices},
          {"tetrahedra", record.counts.cells},
          {"boundary_triangles", record.counts.boundary_triangles},
          {"volume", record.mesh_volume},
          {"hash", record.hash}};
}

Json distribution_json(const mesh::Distribution& d) {
  return {
      {"minimum", d.minimum},
      {"maximum", d.maximum},
      {"mean", d.mean},
      {"percentile_0.1", d.percentile_01},
      {"percentile_1", d.percentile_1},
      {"percentile_5", d.percentile_5},
      {"histogram", {{"low", d.histogram.low}, {"high", d.histogram.high}, {"counts", d.histogram.counts}}}};
}

Json quality_json(const mesh::QualitySummary& quality) {
  Json json = {{"min_dihedral_deg", quality.min_dihedral.minimum},
               {"max_dihedral_deg", quality.max_dihedral.maximum},
               {"min_mean_ratio", quality.mean_ratio.minimum},
               {"mean_mean_ratio", quality.mean_ratio.mean},
               {"min_dihedral", distribution_json(quality.min_dihedral)},
               {"max_dihedral", distribution_json(quality.max_dihedral)},
               {"mean_ratio", distribution_json(quality.mean_ratio)},
               {"radius_ratio", distribution_json(quality.radius_ratio)}};
  json["worst"] = Json::array();
  for (const mesh::WorstCell& cell : quality.worst) {
    json["worst"].push_back(
        {{"min_dihedral_deg", cell.value}, {"cell", cell.cell}, {"center", to_json(cell.center)}});
  }
  return json;
}

/// The angles where cuts end: a histogram by ten degrees, and each one below thirty.
Json cut_angles_json(const RunRecord& record) {
  constexpr double bin = 10, sharp = 30;
  Json sharp_ones = Json::array();
  std::vector<std::int64_t> counts(36, 0);
  double smallest = 360;
  for (const surface::CutAngle& angle : record.surface.cut_angles) {
    smallest = std::min(smallest, angle.degrees);
    ++counts[std::min<std::size_t>(35, static_cast<std::size_t>(angle.degrees / bin))];
    if (angle.degrees >= sharp) continue;
    sharp_ones.push_back({{"face", record.face_names.at(angle.face)},
                          {"point", to_json(angle.point)},
                          {"degrees", angle.degrees}});
  }
  Json json = {{"places", record.surface.cut_angles.size()}, {"counts_by_10_deg", counts}};
  json["smallest_deg"] = record.surface.cut_angles.empty() ? Json() : Json(smallest);
  json["below_30_deg"] = sharp_ones;
  return json;
}

Json sharp_corners_json(const RunRecord& record) {
  Json json = Json::array();
  for (const surface::ListedCorner& corner : record.surface.sharp_corners) {
    json.push_back({{"face", record.face_names.at(corner.face)},
                    {"point", to_json(corner.point)},
                    {"degrees", corner.degrees}});
  }
  return json;
}

Json closed_tips_json(const RunRecord& record) {
  Json json = Json::array();
  for (const surface::ClosedTip& tip : record.surface.closed_tips) {
    json.push_back({{"face", record.face_names.at(tip.face)},
                    {"point", to_json(tip.point)},
                    {"length", tip.length},
                    {"moved", tip.moved}});
  }
  return json;
}

Json needles_json(const RunRecord& record) {
  Json json = Json::array();
  for (const surface::NeedleGroup& group : record.surface.needles) {
    json.push_back({{"face", record.face_names.at(group.face)},
                    {"cause", surface::name_of(group.cause)},
                    {"forced", group.cause != surface::NeedleCause::mesh},
                    {"triangles", group.needles},
                    {"below_half", group.below_half},
                    {"degrees", group.degrees},
                    {"at", to_json(group.at)}});
  }
  return json;
}

Json surface_json(const RunRecord& record) {
  Json json = {
      {"triangles", record.surface.triangles},           {"pieces", record.surface.pieces},
      {"divided_faces", record.surface.divided_faces},   {"cut_angles", cut_angles_json(record)},
      {"sharp_corners", sharp_corners_json(record)},     {"closed_tips", closed_tips_json(record)},
      {"curve_vertices", record.surface.curve_vertices}, {"needles", needles_json(record)},
      {"mending_rounds", record.surface.mending_rounds}, {"load_error_90", record.surface.load_error_90}};
  if (record.surface_quality) {
    json["min_angle_deg"] = record.surface_quality->min_dihedral.minimum;
    json["min_mean_ratio"] = record.surface_quality->mean_ratio.minimum;
    json["mean_mean_ratio"] = record.surface_quality->mean_ratio.mean;
  }
  return json;
}

std::string face_name(const RunRecord& record, std::int32_t face) {
  return face >= 0 && static_cast<std::size_t>(face) < record.face_names.size() ? record.face_names[face]
                                                                                : std::string("unknown");
}

Json unresolved_json(const RunRecord& record) {
  Json list = Json::array();
  for (const improve::UnresolvedFeature& feature : record.pinned.features) {
    const bool is_gap = feature.opposite >= 0;
    list.push_back({{"kind", is_gap ? "gap" : "strip"},
                    {"face", face_name(record, feature.face)},
                    {"opposite", is_gap ? Json(face_name(record, feature.opposite)) : Json()},
                    {"width", feature.width},
                    {"at", to_json(feature.at)},
                    {"tetrahedra", feature.tetrahedra},
                    {"smallest_dihedral_deg", feature.smallest_dihedral}});
  }
  return list;
}

/// Angles are null where there are no such tetrahedra.
Json missed_target_json(const improve::MissedTarget& kind) {
  const bool any = kind.tetrahedra > 0;
  return {{"tetrahedra", kind.tetrahedra},
          {"smallest_dihedral_deg", any ? Json(kind.smallest_angle) : Json()},
          {"largest_dihedral_deg", any ? Json(kind.largest_angle) : Json()}};
}

Json pinned_json(const RunRecord& record) {
  Json list = Json::array();
  const auto name = [&](std::int32_t face) { return face_name(record, face); };
  for (const improve::PinningEntity& entity : record.pinned.entities) {
    const bool between_faces = entity.kind == improve::PinningEntity::Kind::faces;
    Json item = {{"kind", between_faces ? "faces" : "curves"},
                 {"angle_deg", entity.angle},
                 {"smallest_dihedral_deg", entity.smallest_dihedral},
                 {"tetrahedra", entity.tetrahedra},
                 {"at", {entity.at.x, entity.at.y, entity.at.z}}};
    item["faces"] = Json::array({name(entity.faces[0])});
    if (entity.faces[1] != entity.faces[0]) item["faces"].push_back(name(entity.faces[1]));
    if (!between_faces) item["cad_vertex"] = entity.vertex;
    list.push_back(std::move(item));
  }
  return list;
}

Json patches_json(const RunRecord& record) {
  Json json = Json::array();
  for (const PatchRow& patch : record.patches) {
    json.push_back({{"name", patch.name},
                    {"type", mesh::name_of(patch.type)},
                    {"area", patch.area},
                    {"cad_area", patch.cad_area},
                    {"triangles", patch.triangles},
                    {"inner", patch.inner}});
  }
  return json;
}

Json regions_json(const RunRecord& record) {
  Json json = Json::array();
  for (const RegionRow& region : record.regions_filled) {
    json.push_back({{"name", region.name}, {"volume", region.volume}, {"tetrahedra", region.tetrahedra}});
  }
  return json;
}

Json volume_json(const RunRecord& record) {
  const volume::DecompositionReport& decomposition = record.decomposition;
  Json retries = Json::array(), disagreements = Json::array();
  for (const volume::Retry& retry : record.volume.retries)
    retries.push_back({{"zone", retry.zone}, {"change", retry.change}, {"reason", retry.reason}});
  for (const volume::Disagreement& disagreement : record.volume.disagreements) {
    disagreements.push_back({{"place", to_json(disagreement.place)},
                             {"zone", disagreement.zone},
                             {"faces", disagreement.faces},
                             {"round", disagreement.round}});
  }
  return {{"zones", decomposition.zones},
          {"blocks", decomposition.blocks},
          {"lattice_points", decomposition.lattice_points},
          {"expected_tetrahedra", decomposition.expected_tetrahedra},
          {"overlap", record.volume.overlap},
          {"imbalance", decomposition.imbalance},
          {"rounds", record.volume.rounds},
          {"steiner_points", record.volume.steiner_points},
          {"retries", retries},
          {"disagreements", disagreements},
          {"load_error_90", record.volume.load_error_90},
          {"good_edges", record.conformity.good_edges},
          {"mean_edge", record.conformity.mean_edge},
          {"bytes_per_tetrahedron", record.conformity.bytes_per_cell}};
}

Json stages_json(const std::vector<parallel::StageSummary>& stages) {
  Json json = Json::array();
  for (const parallel::StageSummary& stage : stages) {
    json.push_back({{"name", stage.name},
                    {"wall_seconds", stage.wall_seconds},
                    {"cpu_seconds_min", stage.cpu_seconds_min},
                    {"cpu_seconds_mean", stage.cpu_seconds_mean},
                    {"cpu_seconds_max", stage.cpu_seconds_max},
                    {"serial_seconds", stage.serial_seconds},
                    {"check_seconds", stage.check_seconds},
                    {"other_seconds", stage.other_seconds},
                    {"waiting_seconds_mean", stage.waiting_seconds_mean},
                    {"waiting_seconds_max", stage.waiting_seconds_max},
                    {"pieces", stage.pieces},
                    {"peak_rss_bytes_max", stage.peak_resident_bytes_max},
                    {"peak_rss_bytes_sum", stage.peak_resident_bytes_sum},
                    {"peak_own_bytes_max", stage.peak_own_bytes_max},
                    {"peak_own_bytes_sum", stage.peak_own_bytes_sum}});
  }
  return json;
}

Json improve_json(const RunRecord& record) {
  return {{"bad_before", record.improve.bad_before},
          {"bad_after", record.improve.bad_after},
          {"smoothed", record.improve.smoothed},
          {"swaps", record.improve.swaps},
          {"slid", record.improve.slid},
          {"changed_triangles", record.improve.changed_triangles},
          {"pinned_tetrahedra", record.pinned.tetrahedra},
          {"unpinned_below_target", record.pinned.others},
          {"below_target",
           {{"pinned", missed_target_json(record.pinned.pinned)},
            {"unresolved_features", missed_target_json(record.pinned.at_features)},
            {"rest", missed_target_json(record.pinned.rest)}}}};
}

/// What every report begins with.
Json outcome_json(const Case& input, const RunOutcome& outcome, int ranks) {
  Json json;
  json["schema_version"] = schema_version;
  json["program"] = {{"name", "aeroloom"}, {"version", AEROLOOM_VERSION}};
  json["status"] = outcome.code == ExitCode::ok ? "ok" : "failed";
  json["exit_code"] = static_cast<int>(outcome.code);
  if (outcome.code != ExitCode::ok)
    json["failure"] = {{"stage", outcome.stage}, {"message", outcome.message}};
  json["ranks"] = ranks;
  json["configuration"] = resolved_yaml(input);
  return json;
}

/// What every report says of the finished mesh.
void add_finished_mesh(Json& json, const RunRecord& record,
                       const std::vector<parallel::StageSummary>& stages) {
  json["mesh"] = mesh_json(record);
  if (record.quality) json["quality"] = quality_json(*record.quality);
  if (record.cells) json["quality"]["cells"] = to_json(*record.cells);
  json["improve"] = improve_json(record);
  json["pinned"] = pinned_json(record);
  json["unresolved_features"] = unresolved_json(record);
  json["patches"] = patches_json(record);
  json["regions"] = regions_json(record);
  json["resumed"] = record.resumed;
  json["wall_seconds"] = record.wall_seconds;
  json["stages"] = stages_json(stages);
}

}  // namespace

std::string report_json(const Case& input, const RunRecord& record,
                        const std::vector<parallel::StageSummary>& stages, const RunOutcome& outcome,
                        int ranks) {
  Json json = outcome_json(input, outcome, ranks);
  json["geometry"] = geometry_json(record);
  json["sizing"] = sizing_json(record);
  json["surface"] = surface_json(record);
  json["volume"] = volume_json(record);
  add_finished_mesh(json, record, stages);
  return json.dump(2) + "\n";
}

std::string improve_report_json(const std::string& file, const Case& input, const RunRecord& record,
                                const std::vector<parallel::StageSummary>& stages, const RunOutcome& outcome,
                                int ranks) {
  Json json = outcome_json(input, outcome, ranks);
  json["input"] = file;
  add_finished_mesh(json, record, stages);
  return json.dump(2) + "\n";
}

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
  text += fmt::format(
      "mesh: {} tetrahedra, {} points, {} boundary triangles, volume {:.10g}\n"
      "quality: dihedral angles {:.2f} to {:.2f} degrees, mean ratio {:.3f} at least, {:.3f} on average\n"
      "hash: {}\n",
      record.counts.cells, record.counts.vertices, record.counts.boundary_triangles, record.mesh_volume,
      record.quality->min_dihedral.minimum, record.quality->max_dihedral.maximum,
      record.quality->mean_ratio.minimum, record.quality->mean_ratio.mean, record.hash);
  text +=
      fmt::format("{:<28} {:<9} {:>10} {:>14} {:>14}\n", "patch", "type", "triangles", "area", "CAD area");
  for (const PatchRow& p : record.patches) {
    text += fmt::format("{:<28} {:<9} {:>10} {:>14.8g} {:>14.8g}\n", p.name, mesh::name_of(p.type),
                        p.triangles, p.area, p.cad_area);
  }
  return text;
}

}  // namespace aeroloom::pipeline
