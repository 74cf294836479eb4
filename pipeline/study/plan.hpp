/// Lists the runs of a scaling study.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::study {

using Json = nlohmann::ordered_json;

/// `serial`: one rank and one piece, the best time on one core and the reference of speed-up. `strong`: a
/// fixed mesh on more and more ranks. `weak`: a mesh that grows with the ranks.
enum class Series { serial, strong, weak };
std::string_view name_of(Series series);

/// Options of a study.
struct StudyOptions {
  std::string program;                 ///< path of the program
  std::string case_file;               ///< absolute path
  std::vector<std::string> overrides;  ///< of the case: "key=value"
  std::filesystem::path directory;     ///< of results, absolute; each run has a folder in runs/
  std::vector<int> ranks;              ///< ascending, without repetition
  bool serial = true, strong = true, weak = false;
  int repeats = 3;
  int ranks_per_node = 0;  ///< 0: all on one node
};

/// One run.
struct RunSpec {
  Series series = Series::strong;
  int ranks = 1;
  int repeat = 1;                     ///< from 1
  std::vector<std::string> settings;  ///< "key=value", besides those of the study

  std::string name() const;  ///< "strong_4_2"; also the name of its folder
};

/// Settings that multiply the number of elements of a case by a factor.
struct WeakScale {
  int ranks = 1;
  std::vector<std::string> settings;
};

/// All runs. Repeats cycle through the numbers of ranks, so that temporary load on the machine affects all
/// equally.
std::vector<RunSpec> plan_runs(const StudyOptions& options, const std::vector<WeakScale>& weak);

/// Number of nodes for this number of ranks.
int nodes_for(int ranks, int ranks_per_node);
std::filesystem::path folder_of(const std::filesystem::path& directory, const RunSpec& run);

Json to_json(const RunSpec& run);
RunSpec run_of(const Json& json);

/// A file that a study reads, or several as one, known by its content.
struct StudyInput {
  std::string name;  ///< for messages
  std::string hash;  ///< empty: there is none, or it cannot be read
};

/// The stored description of a study. `subject`: the lines of the case except the output section; studies of
/// different subjects or geometry are not mixed.
struct StudyRecord {
  StudyOptions options;
  std::string subject;
  StudyInput geometry = {};  ///< with all that is read beside it; hash as in the report of a run
  StudyInput network = {};   ///< of --network, which predictions depend on, and runs do not
  std::string versions;      ///< of program and libraries, one line
  std::vector<RunSpec> runs;
};

/// Writes study.json in the folder. Throws std::runtime_error with the name of the file.
void save(const StudyRecord& record);
/// Throws as save(); also for a folder without a study.
StudyRecord load_study(const std::filesystem::path& directory);
bool holds_study(const std::filesystem::path& directory);

/// Throws std::invalid_argument, with the first different lines, if the folder has a study of another case,
/// or its geometry has changed; std::runtime_error if the geometry can no longer be read.
void require_same_subject(const StudyRecord& earlier, const StudyRecord& now);

}  // namespace aeroloom::study
