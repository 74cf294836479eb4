/// Marks and reports that the runs of a study have left, and the figures that are compared.
#pragma once

#include "pipeline/study/plan.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace aeroloom::study {

/// How far a run has come, as the marks beside its report tell. `begun` is one that is under way, or that was
/// ended without a word.
enum class RunState { planned, queued, begun, ended, failed };
std::string_view name_of(RunState state);

/// The file `marks` in a run's folder: a line when it begins, one when it ends. Scripts of jobs write the
/// same lines.
struct RunMarks {
  RunState state = RunState::planned;
  int code = 0;              ///< of an ended or failed one
  double seconds = 0;        ///< from the first begin to the last end
  int attempts = 0;          ///< how often it was begun
  std::int64_t process = 0;  ///< the process group, or the job that began last
  std::string host;          ///< where it began last
};
void mark_begin(const std::filesystem::path& folder, std::int64_t process);
void mark_end(const std::filesystem::path& folder, int code);
RunMarks read_marks(const std::filesystem::path& folder);

/// One stage of one run.
struct StageFigures {
  std::string name;
  double wall = 0;                       ///< seconds, of the slowest rank
  double busy = 0;                       ///< CPU seconds of the busiest rank: tasks, checks and all else
  double serial = 0;                     ///< CPU seconds that more ranks do not make fewer
  double waiting = 0;                    ///< seconds in messages, mean over ranks
  double tasks_mean = 0, tasks_max = 0;  ///< CPU seconds of tasks
};

/// The figures by which finished runs are compared. Memory in bytes.
struct RunFigures {
  double wall = 0, busy = 0, serial = 0, waiting = 0;
  double imbalance = 1;  ///< CPU of tasks: busiest rank over the mean, summed over stages
  double tetrahedra = 0;
  double memory_of_rank = 0, memory_of_all = 0;
  std::string hash, input_hash;
  std::vector<StageFigures> stages;

  double rate(int ranks, bool by_cpu) const { return tetrahedra / (by_cpu ? busy : wall) / ranks; }
};

struct RunResult {
  RunSpec spec;
  RunMarks marks;
  std::optional<RunFigures> figures;  ///< of one that ended well
  std::string failure;                ///< what its report or its log says, one line
};

RunFigures figures_of(const Json& report);

/// Of all runs of a study; `queue` has what a queueing system says of jobs, by names of runs.
std::vector<RunResult> collect_runs(const StudyRecord& record,
                                    const std::map<std::string, std::string>& queue = {});

/// The strong run on the smallest number of ranks that has ended well, of its repeats the one with the median
/// CPU time: whose records foretell the others. Null without one.
const RunResult* telling_run(const std::vector<RunResult>& runs);
/// The ranks of the strong series, and powers of two up to four times the largest.
std::vector<int> ranks_to_foretell(const std::vector<RunResult>& runs);

/// Throws std::runtime_error that names runs of equal configuration with different meshes, or runs that read
/// different files.
void require_equal_meshes(const std::vector<RunResult>& runs);

/// Removes all but reports, marks and logs from the folder of a run.
void remove_meshes(const std::filesystem::path& folder);

}  // namespace aeroloom::study
