/// The figures of a study, one row for each configuration: medians, speed-up, efficiency.
#pragma once

#include "pipeline/study/machine.hpp"
#include "pipeline/study/results.hpp"

#include <string>
#include <vector>

namespace aeroloom::study {

/// All runs of one series on one number of ranks.
struct SeriesRow {
  Series series = Series::strong;
  int ranks = 1, nodes = 1;
  int planned = 0, ended = 0, failed = 0;
  bool by_cpu =
      false;          ///< more ranks than processors: judged by the CPU of the busiest rank, not by the clock
  RunFigures median;  ///< the figures of the run with the median wall time, or CPU time; where any ended
  double least = 0, most = 0;    ///< seconds over the runs
  double speedup = 0;            ///< against one rank in one piece; 0: there is none
  double speedup_of_series = 0;  ///< against the smallest number of ranks of its series, times that number
  double efficiency = 0;  ///< speed-up over ranks; of a weak series elements a second and core over the first

  double seconds() const { return by_cpu ? median.busy : median.wall; }
};

/// In the order serial, strong, weak, and by ranks.
std::vector<SeriesRow> make_rows(const StudyRecord& record, const std::vector<RunResult>& runs,
                                 const Machine& machine);

/// The JSON beside the page: keys are stable within a schema_version.
Json study_json(const StudyRecord& record, const std::vector<RunResult>& runs,
                const std::vector<SeriesRow>& rows, const Machine& machine);
/// A line for each run, with a head.
std::string study_csv(const std::vector<RunResult>& runs);
/// The rows for a terminal.
std::string study_text(const std::vector<SeriesRow>& rows);

}  // namespace aeroloom::study
