#include "pipeline/report/report_json.hpp"

#include "pipeline/report/library_versions.hpp"
#include "pipeline/report/parts_json.hpp"

#include <filesystem>

namespace aeroloom::report {
namespace {

constexpr int report_schema_version = 3;

Json versions_json() {
  Json versions = {{"aeroloom", program_version()}};
  for (const auto& [library, version] : library_versions()) versions[library] = version;
  return versions;
}

/// The geometry or the mesh that the run began with.
Json input_json(const cases::Case& input, const RunRecord& record, const ReportSubject& subject) {
  const bool is_mesh = !subject.improved_file.empty();
  const std::string& file = is_mesh ? subject.improved_file : input.domain.file;
  std::error_code error;
  const auto bytes = file.empty()                 ? 0
                     : !record.input_hash.empty() ? static_cast<std::uintmax_t>(record.input_bytes)
                                                  : std::filesystem::file_size(file, error);
  Json json;
  json["kind"] = is_mesh ? "mesh" : file.empty() ? "builtin" : "cad";
  json["file"] = file.empty() ? Json() : Json(file);
  json["bytes"] = file.empty() || error ? Json() : Json(bytes);
  json["hash"] = record.input_hash.empty() ? Json() : Json(record.input_hash);
  return json;
}

Json warnings_json(const parallel::Warnings& warnings) {
  Json json = Json::array();
  for (const parallel::Warning& warning : warnings.kept)
    json.push_back({{"message", warning.message}, {"rank", warning.rank}, {"times", warning.times}});
  return json;
}

Json pictures_json(const std::vector<Picture>& pictures) {
  Json json = Json::array();
  for (const Picture& picture : pictures)
    json.push_back({{"name", picture.name}, {"caption", picture.caption}});
  return json;
}

/// The beginning of every report.
Json outcome_json(const cases::Case& input, const RunRecord& record, const ReportFacts& facts) {
  const RunOutcome& outcome = facts.outcome;
  Json json;
  json["schema_version"] = report_schema_version;
  json["program"] = {{"name", "aeroloom"}, {"version", program_version()}};
  json["versions"] = versions_json();
  json["status"] = outcome.code == ExitCode::ok ? "ok" : "failed";
  json["exit_code"] = static_cast<int>(outcome.code);
  if (outcome.code != ExitCode::ok)
    json["failure"] = {{"stage", outcome.stage}, {"message", outcome.message}};
  json["date"] = facts.date;
  json["ranks"] = facts.ranks;
  json["case"] = facts.subject.case_file.empty() ? Json() : Json(facts.subject.case_file);
  json["input"] = input_json(input, record, facts.subject);
  json["configuration"] = cases::resolved_yaml(input);
  json["resumed"] = record.resumed;
  json["older_files"] = outcome.older_files;
  json["warnings"] = warnings_json(facts.warnings);
  json["warnings_left_out"] = facts.warnings.left_out;
  return json;
}

/// Adds what every report says of the finished mesh.
void add_finished_mesh(Json& json, const cases::Case& input, const RunRecord& record,
                       const ReportFacts& facts) {
  json["mesh"] = mesh_json(record);
  if (record.quality) json["quality"] = quality_json(input, record);
  json["improve"] = improve_json(input, record);
  json["pinned"] = pinned_json(record);
  json["unresolved_features"] = unresolved_json(record);
  json["patches"] = patches_json(record);
  json["faces"] = faces_json(input, record);
  json["regions"] = regions_json(record);
  json["pictures"] = pictures_json(record.pictures);
  json["wall_seconds"] = record.wall_seconds;
  json["stages"] = stages_json(facts.stages);
}

}  // namespace

std::string report_json(const cases::Case& input, const RunRecord& record, const ReportFacts& facts) {
  Json json = outcome_json(input, record, facts);
  if (facts.subject.improved_file.empty()) {
    json["geometry"] = geometry_json(record);
    json["sizing"] = sizing_json(record);
    json["surface"] = surface_json(record);
    if (record.layers) json["layers"] = layers_json(record);
    json["volume"] = volume_json(record);
  }
  add_finished_mesh(json, input, record, facts);
  json["scaling"] = scaling_json(json, facts.tasks);
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace aeroloom::report
