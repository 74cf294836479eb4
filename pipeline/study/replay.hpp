/// Predicts a run on other numbers of ranks by replaying a recorded one: the same scheduling with recorded
/// task costs, recorded serial and repeated work, and exchanges by latency and bandwidth
/// (docs/scaling_model.md).
#pragma once

#include "pipeline/study/costs.hpp"
#include "pipeline/study/exchange_model.hpp"

#include <string>
#include <vector>

namespace aeroloom::study {

inline constexpr int most_ranks_predicted = 1'000'000;

/// Seconds lost against equal work on all ranks.
struct Losses {
  double serial = 0;         ///< one rank works, the others wait
  double repeated = 0;       ///< every rank does the same work
  double granularity = 0;    ///< the largest task exceeds the mean load of a rank
  double imbalance = 0;      ///< loads of ranks differ, because scheduling uses predicted loads
  double communication = 0;  ///< message exchanges
  double waiting = 0;        ///< ranks wait for each other between rounds and batches

  double sum() const { return serial + repeated + granularity + imbalance + communication + waiting; }
  Losses& operator+=(const Losses& more);
};

struct StagePrediction {
  std::string name;
  double seconds = 0;
  double busy_seconds = 0;  ///< CPU of the busiest rank
  Losses losses;            ///< `seconds` is their sum plus the mean load
  double bytes = 0;         ///< memory of the largest rank
};

struct Prediction {
  int ranks = 1;
  double seconds = 0, busy_seconds = 0;
  double one_rank_seconds = 0;  ///< all work on one rank
  Losses losses;
  double bytes = 0;  ///< of the stage with most memory
  std::vector<StagePrediction> stages;

  double speedup() const { return seconds > 0 ? one_rank_seconds / seconds : 0; }
  double efficiency() const { return speedup() / ranks; }
};

/// Throws std::invalid_argument for numbers of ranks below 1 or above most_ranks_predicted, and for invalid
/// networks (bandwidth not positive, latency negative).
Prediction predict(const RunCosts& costs, int ranks, const Network& network);

/// The largest number of ranks up to `most` with at least this efficiency; 1 if two ranks miss it. Large
/// numbers are sampled (about every 64th part).
int ranks_at_efficiency(const RunCosts& costs, const Network& network, double efficiency, int most = 10'000);

}  // namespace aeroloom::study
