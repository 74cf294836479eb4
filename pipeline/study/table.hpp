/// The table of a study: medians, speed-up and efficiency of each configuration.
#pragma once

#include "pipeline/study/machine.hpp"
#include "pipeline/study/results.hpp"

#include <optional>
#include <string>
#include <vector>

namespace aeroloom::study {

/// All runs of one series on one number of ranks.
struct SeriesRow {
  Series series = Series::strong;
  int ranks = 1, nodes = 1;
  int planned = 0, ended = 0, failed = 0;
  bool by_cpu = false;  ///< more ranks than processors: CPU of the busiest rank replaces wall time
  RunFigures median;    ///< the run with median time, if any has ended; of two in the middle their mean
  double least = 0, most = 0;    ///< shortest and longest time
  std::optional<double> beside;  ///< most processors that other programs kept busy during a run, if known
  double speedup = 0;            ///< over one rank and one piece; 0: not known
  double speedup_of_series = 0;  ///< over the fewest ranks of the series, times that number of ranks
  double efficiency = 0;  ///< speed-up over ranks; weak series: rate per core over that of the first row

  double seconds() const { return by_cpu ? median.busy : median.wall; }
};

/// Ordered serial, strong, weak; then by ranks.
std::vector<SeriesRow> make_rows(const StudyRecord& record, const std::vector<RunResult>& runs,
                                 const Machine& machine);

/// scaling.json. Keys are stable within a schema_version.
Json study_json(const StudyRecord& record, const std::vector<RunResult>& runs,
                const std::vector<SeriesRow>& rows, const Machine& machine);
/// scaling.csv: a heading and one line for each run.
std::string study_csv(const std::vector<RunResult>& runs);
/// The rows as text.
std::string study_text(const std::vector<SeriesRow>& rows);

}  // namespace aeroloom::study
