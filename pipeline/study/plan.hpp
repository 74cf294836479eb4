/// Which runs a scaling study is made of.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::study {

using Json = nlohmann::ordered_json;

/// `serial` is one rank that makes the mesh in one piece, the best way through the program for one core: what
/// speed-up is measured against. `strong`: one mesh by more and more ranks; `weak`: a mesh that grows with
/// them.
enum class Series { serial, strong, weak };
std::string_view name_of(Series series);

/// The study that the user asks for.
struct StudyOptions {
  std::string program;                 ///< its path
  std::string case_file;               ///< absolute
  std::vector<std::string> overrides;  ///< of the case, "key=value"
  std::filesystem::path directory;     ///< of results, absolute; runs are in runs/ below it
  std::vector<int> ranks;              ///< ascending, each once
  bool serial = true, strong = true, weak = false;
  int repeats = 3;
  int ranks_per_node = 0;  ///< 0: all on one node
};

/// One run.
struct RunSpec {
  Series series = Series::strong;
  int ranks = 1;
  int repeat = 1;                     ///< from 1
  std::vector<std::string> settings;  ///< "key=value", in addition to those of the study

  std::string name() const;  ///< "strong_4_2"; also of its folder
};

/// Settings of keys that multiply the elements of a case by a factor.
struct WeakScale {
  int ranks = 1;
  std::vector<std::string> settings;
};

/// All runs; repeats go round the numbers of ranks, so that what disturbs a machine for a while disturbs all
/// alike.
std::vector<RunSpec> plan_runs(const StudyOptions& options, const std::vector<WeakScale>& weak);

/// Nodes that a number of ranks takes.
int nodes_for(int ranks, int ranks_per_node);
std::filesystem::path folder_of(const std::filesystem::path& directory, const RunSpec& run);

Json to_json(const RunSpec& run);
RunSpec run_of(const Json& json);

/// The memory of a study in its folder. `subject` tells apart what must not be mixed: the case without where
/// results go, as lines.
struct StudyRecord {
  StudyOptions options;
  std::string subject;
  std::string versions;  ///< of the program and its libraries, one line
  std::vector<RunSpec> runs;
};

/// In the folder, as study.json. Throws std::runtime_error that names the file where it cannot be read or
/// written.
void save(const StudyRecord& record);
/// Throws as save; for a folder without a study, too.
StudyRecord load_study(const std::filesystem::path& directory);
bool holds_study(const std::filesystem::path& directory);

/// Throws std::invalid_argument with the first lines that differ where the folder has a study of another
/// case.
void require_same_subject(const StudyRecord& earlier, const StudyRecord& now);

}  // namespace aeroloom::study
