#include "pipeline/study/plan.hpp"

#include "pipeline/study/text_files.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::study {

namespace fs = std::filesystem;

namespace {

constexpr const char* record_name = "study.json";
/// No case has that many elements.
const std::vector<std::string> in_one_piece{"surface.piece_triangles=1e9", "volume.piece_tets=1e9"};

Series series_called(const std::string& name) {
  for (const Series series : {Series::serial, Series::strong, Series::weak})
    if (name == name_of(series)) return series;
  throw std::runtime_error(fmt::format("no series is called '{}'", name));
}

Json input_json(const StudyInput& input) {
  return {{"name", input.name}, {"hash", input.hash.empty() ? Json() : Json(input.hash)}};
}

StudyInput input_of(const Json& inputs, const char* key) {
  if (!inputs.contains(key)) return {};
  const Json& input = inputs.at(key);
  return {input.at("name").get<std::string>(),
          input.at("hash").is_null() ? std::string() : input.at("hash").get<std::string>()};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

std::string_view name_of(Series series) {
  return series == Series::serial ? "serial" : series == Series::strong ? "strong" : "weak";
}

std::string RunSpec::name() const {
  return fmt::format("{}_{}_{}", name_of(series), ranks, repeat);
}

std::vector<RunSpec> plan_runs(const StudyOptions& options, const std::vector<WeakScale>& weak) {
  std::vector<RunSpec> runs;
  for (int repeat = 1; repeat <= options.repeats; ++repeat) {
    if (options.serial) runs.push_back({Series::serial, 1, repeat, in_one_piece});
    if (options.strong)
      for (const int ranks : options.ranks) runs.push_back({Series::strong, ranks, repeat, {}});
    for (const WeakScale& scale : weak) runs.push_back({Series::weak, scale.ranks, repeat, scale.settings});
  }
  return runs;
}

int nodes_for(int ranks, int ranks_per_node) {
  return ranks_per_node > 0 ? (ranks + ranks_per_node - 1) / ranks_per_node : 1;
}

fs::path folder_of(const fs::path& directory, const RunSpec& run) {
  return directory / "runs" / run.name();
}

Json to_json(const RunSpec& run) {
  return {{"series", name_of(run.series)},
          {"ranks", run.ranks},
          {"repeat", run.repeat},
          {"settings", run.settings}};
}

RunSpec run_of(const Json& json) {
  RunSpec run{series_called(json.at("series").get<std::string>()), json.at("ranks").get<int>(),
              json.at("repeat").get<int>(), json.at("settings").get<std::vector<std::string>>()};
  if (run.ranks < 1 || run.repeat < 1)
    throw std::runtime_error(fmt::format("a run '{}' is none", run.name()));
  return run;
}

void save(const StudyRecord& record) {
  const StudyOptions& options = record.options;
  Json runs = Json::array();
  for (const RunSpec& run : record.runs) runs.push_back(to_json(run));
  Json json{
      {"program", options.program},  {"case", options.case_file},  {"overrides", options.overrides},
      {"ranks", options.ranks},      {"repeats", options.repeats}, {"ranks_per_node", options.ranks_per_node},
      {"versions", record.versions}, {"subject", record.subject},  {"runs", std::move(runs)}};
  json["inputs"] = {{"geometry", input_json(record.geometry)}, {"network", input_json(record.network)}};
  write_file(options.directory / record_name,
             json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

bool holds_study(const fs::path& directory) {
  return fs::exists(directory / record_name);
}

StudyRecord load_study(const fs::path& directory) {
  const fs::path file = directory / record_name;
  const Json json = read_json(file);
  try {
    StudyRecord record;
    record.options.program = json.at("program").get<std::string>();
    record.options.case_file = json.at("case").get<std::string>();
    record.options.overrides = json.at("overrides").get<std::vector<std::string>>();
    record.options.directory = directory;
    record.options.ranks = json.at("ranks").get<std::vector<int>>();
    record.options.repeats = json.at("repeats").get<int>();
    record.options.ranks_per_node = json.at("ranks_per_node").get<int>();
    record.versions = json.at("versions").get<std::string>();
    record.subject = json.at("subject").get<std::string>();
    const Json inputs = json.value("inputs", Json::object());
    record.geometry = input_of(inputs, "geometry");
    record.network = input_of(inputs, "network");
    for (const Json& run : json.at("runs")) record.runs.push_back(run_of(run));
    return record;
  } catch (const std::exception& error) {
    refuse_json(file, "the record of a study", error);
  }
}

void require_same_subject(const StudyRecord& earlier, const StudyRecord& now) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument(fmt::format(
        "'{}' holds a study of another case: {}. Remedy: another output.directory, or remove that folder",
        now.options.directory.string(), what));
  };
  if (earlier.versions != now.versions)
    refuse(fmt::format("it was made by {}, this is {}", earlier.versions, now.versions));
  const std::vector<std::string> old = lines_of(earlier.subject), recent = lines_of(now.subject);
  const auto [was, is] = std::mismatch(old.begin(), old.end(), recent.begin(), recent.end());
  if (was == old.end() && is == recent.end()) {
    if (earlier.geometry.hash.empty() || earlier.geometry.hash == now.geometry.hash) return;
    if (now.geometry.hash.empty())
      throw std::runtime_error(
          fmt::format("cannot read the geometry of the study in '{}', '{}' or a file beside it",
                      now.options.directory.string(), now.geometry.name));
    refuse(
        fmt::format("its geometry, '{}' with all that is read beside it, has changed since (hash {}, now {})",
                    now.geometry.name, earlier.geometry.hash, now.geometry.hash));
  }
  refuse(fmt::format("it has '{}', this case '{}'", was == old.end() ? "" : *was,
                     is == recent.end() ? "" : *is));
}

}  // namespace aeroloom::study
