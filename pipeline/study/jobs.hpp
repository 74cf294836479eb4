/// A study for a queueing system: a script for each run, and what became of them.
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
  std::filesystem::path folder;  ///< where scripts are written, absolute
  std::string header;            ///< lines for every script: account, partition, modules
  std::string launcher;          ///< as make_launcher takes it; empty: srun
};

/// Writes NAME.slurm and NAME.sh (for other systems) for each run that has not ended well, and submit.sh.
/// `forecast` predicts a run of these settings. A job keeps checkpoints; two minutes before its time is over
/// the queue tells it, it ends its run and submits itself anew, to go on from there.
void write_jobs(const StudyRecord& record, const JobOptions& options,
                const std::function<CaseForecast(const std::vector<std::string>&)>& forecast);

/// The folder of results that jobs written into `folder` have. Throws std::runtime_error.
std::filesystem::path results_of_jobs(const std::filesystem::path& folder);

/// The word of sacct on the jobs that submit.sh and the jobs themselves have noted, by names of runs; where
/// it does not answer, what the queue wrote last into what the job printed (that a node failed, that time was
/// over).
std::map<std::string, std::string> ask_queue(const std::filesystem::path& folder);

}  // namespace aeroloom::study
