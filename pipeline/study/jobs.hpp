/// Runs a study through a batch system: writes a script for each run and collects the results.
#pragma once

#include "pipeline/study/launcher.hpp"
#include "pipeline/study/plan.hpp"
#include "pipeline/study/series.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace aeroloom::study {

struct JobOptions {
  std::filesystem::path folder;  ///< for the scripts; absolute
  std::string header;            ///< lines for each script: account, partition, modules
  std::string launcher;          ///< argument of make_launcher(); empty: srun, and mpirun for other systems
};

/// Writes NAME.slurm and NAME.sh (for other systems) for each run that has not succeeded, and submit.sh.
/// `forecast` predicts a run with these settings. A job writes checkpoints. The queue signals it two minutes
/// before its time limit; it then ends the run and submits itself again to resume. Names, paths and settings
/// reach no shell but as values. Throws std::invalid_argument for a launcher as make_launcher(), and for
/// folders that no script can name.
void write_jobs(const StudyRecord& record, const JobOptions& options,
                const std::function<CaseForecast(const std::vector<std::string>&)>& forecast);

/// The folder of results of the jobs in `folder`. Throws std::runtime_error.
std::filesystem::path results_of_jobs(const std::filesystem::path& folder);

/// The state of the submitted jobs by run name, from sacct. If sacct does not answer: the last message of the
/// queue in the job's output (node failure, time limit).
std::map<std::string, std::string> query_queue(const std::filesystem::path& folder);

}  // namespace aeroloom::study
