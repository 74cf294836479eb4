/// Collects the results of a study's runs.
#pragma once

#include "pipeline/study/plan.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::study {

/// The state of a run by its marks. `begun`: still running, or killed.
enum class RunState { planned, queued, begun, ended, failed };
std::string_view name_of(RunState state);

/// Contents of the file `marks` in a run's folder: one line at the beginning and one at the end of an
/// attempt. Scripts of jobs write the same lines.
struct RunMarks {
  RunState state = RunState::planned;
  int code = 0;              ///< of an ended or failed run
  double seconds = 0;        ///< from the first beginning to the last end
  int attempts = 0;          ///< number of attempts
  std::int64_t process = 0;  ///< process group or job of the last attempt
  std::string host;          ///< of the last attempt
  std::optional<double>
      beside;  ///< processors that other programs kept busy during the last attempt, if known
};
/// As marks have it.
std::string host_name();
void mark_begin(const std::filesystem::path& folder, std::int64_t process);
void mark_end(const std::filesystem::path& folder, int code, std::optional<double> beside = {});
RunMarks read_marks(const std::filesystem::path& folder);

/// One stage of one run.
struct StageFigures {
  std::string name;
  double wall = 0;                       ///< seconds of the slowest rank
  double busy = 0;                       ///< CPU seconds of the busiest rank, all included
  double serial = 0;                     ///< CPU seconds that do not shrink with more ranks
  double waiting = 0;                    ///< seconds in messages, mean over ranks
  double tasks_mean = 0, tasks_max = 0;  ///< CPU seconds of tasks
};

/// Figures of a finished run, for comparison. Memory in bytes.
struct RunFigures {
  double wall = 0, busy = 0, serial = 0, waiting = 0;
  double imbalance = 1;  ///< CPU of tasks: maximum over mean of the ranks, summed over stages
  double tetrahedra = 0;
  double memory_of_rank = 0, memory_of_all = 0;
  std::string hash, input_hash;
  std::vector<StageFigures> stages;

  double rate(int ranks, bool by_cpu) const { return tetrahedra / (by_cpu ? busy : wall) / ranks; }
};

struct RunResult {
  RunSpec spec;
  RunMarks marks;
  std::optional<RunFigures> figures;  ///< of a successful run
  std::string failure;                ///< one line from its report or log, or what is wrong with these
  int reported_code = 0;              ///< of a failed run, by its report; 0: there is none
};

/// Throws std::runtime_error with what the report of a finished run lacks.
RunFigures figures_of(const Json& report);
/// The means of two runs that made the same mesh: half of them each.
RunFigures mean_of(const RunFigures& one, const RunFigures& other);

/// What a run has left in its folder. One that has ended without the report of a finished run has failed.
RunResult result_of(const std::filesystem::path& directory, const RunSpec& spec);

/// The results of all runs. `queue`: states of jobs by run name (query_queue()).
std::vector<RunResult> collect_runs(const StudyRecord& record,
                                    const std::map<std::string, std::string>& queue = {});

/// The successful strong run on fewest ranks, from which others are predicted; of its repeats the one with
/// median CPU time. Null if there is none.
const RunResult* recorded_run(const std::vector<RunResult>& runs);
/// The ranks of the strong series, and powers of two up to four times the largest.
std::vector<int> ranks_to_predict(const std::vector<RunResult>& runs);

/// Whether a run has ended well and has read the geometry that the study has.
bool is_done(const StudyRecord& record, const RunResult& run);
/// Throws std::runtime_error with the name of a run that has read other geometry than the study has.
void require_geometry(const StudyRecord& record, const std::vector<RunResult>& runs);
/// Throws std::runtime_error with the names of runs of equal configuration but different meshes or input
/// files.
void require_equal_meshes(const std::vector<RunResult>& runs);

/// Removes all files of a run except reports, marks and logs.
void remove_meshes(const std::filesystem::path& folder);

}  // namespace aeroloom::study
