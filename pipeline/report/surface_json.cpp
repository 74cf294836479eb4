#include "pipeline/report/change_json.hpp"
#include "pipeline/report/parts_json.hpp"

namespace aeroloom::report {
namespace {

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

Json closed_cusps_json(const RunRecord& record) {
  Json json = Json::array();
  for (const surface::ClosedCusp& cusp : record.surface.closed_cusps) {
    json.push_back({{"face", record.face_names.at(cusp.face)},
                    {"point", to_json(cusp.point)},
                    {"length", cusp.length},
                    {"moved", cusp.moved}});
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

Json rows_json(const RunRecord& record) {
  Json json = Json::array();
  for (const surface::RowsMade& rows : record.surface.rows) {
    json.push_back({{"edge", rows.edge},
                    {"height", rows.height},
                    {"length", rows.length},
                    {"with_rows", rows.with_rows},
                    {"stretched", rows.stretched},
                    {"longest", rows.longest},
                    {"most", rows.most}});
  }
  return json;
}

}  // namespace

Json surface_json(const RunRecord& record) {
  Json json = {
      {"triangles", record.surface.triangles},           {"pieces", record.surface.pieces},
      {"divided_faces", record.surface.divided_faces},   {"cut_angles", cut_angles_json(record)},
      {"sharp_corners", sharp_corners_json(record)},     {"closed_tips", closed_cusps_json(record)},
      {"curve_vertices", record.surface.curve_vertices}, {"needles", needles_json(record)},
      {"mending_rounds", record.surface.mending_rounds}, {"load_error_90", record.surface.load_error_90}};
  if (!record.surface.rows.empty()) json["rows"] = rows_json(record);
  if (record.surface_quality) {
    json["min_angle_deg"] = record.surface_quality->min_dihedral.minimum;
    json["min_mean_ratio"] = record.surface_quality->mean_ratio.minimum;
    json["mean_mean_ratio"] = record.surface_quality->mean_ratio.mean;
  }
  return json;
}

}  // namespace aeroloom::report
