/// A run replayed on other numbers of ranks: the program's schedule on the recorded costs of its tasks,
/// serial and repeated work as recorded, exchanges by latency and bandwidth (docs/scaling_model.md).
#pragma once

#include "pipeline/study/costs.hpp"
#include "pipeline/study/exchange_model.hpp"

#include <string>
#include <vector>

namespace aeroloom::study {

inline constexpr int most_ranks_predicted = 1'000'000;

/// Where seconds go that an even share of all work would not take.
struct Losses {
  double serial = 0;         ///< one rank works, the others wait
  double repeated = 0;       ///< every rank does the same
  double granularity = 0;    ///< the largest task takes longer than a rank's share
  double imbalance = 0;      ///< tasks are scheduled by predicted loads, and do not add up to equal shares
  double communication = 0;  ///< exchanges
  double waiting = 0;        ///< ranks wait for each other between rounds and batches

  double sum() const { return serial + repeated + granularity + imbalance + communication + waiting; }
  Losses& operator+=(const Losses& more);
};

struct StagePrediction {
  std::string name;
  double seconds = 0;
  double busy_seconds = 0;  ///< CPU of the busiest rank
  Losses losses;            ///< seconds are their sum and an even share of the work
  double bytes = 0;         ///< memory of the largest rank
};

struct Prediction {
  int ranks = 1;
  double seconds = 0, busy_seconds = 0;
  double one_rank_seconds = 0;  ///< all work, by one rank
  Losses losses;
  double bytes = 0;  ///< of the stage with most
  std::vector<StagePrediction> stages;

  double speedup() const { return seconds > 0 ? one_rank_seconds / seconds : 0; }
  double efficiency() const { return speedup() / ranks; }
};

/// Throws std::invalid_argument for fewer ranks than one or more than most_ranks_predicted, and for a network
/// without positive bandwidth or with negative latency.
Prediction predict(const RunCosts& costs, int ranks, const Network& network);

/// The largest number of ranks up to `most` that works with at least this efficiency; 1 where two do not. Of
/// large numbers each sixty-fourth or so is looked at.
int ranks_at_efficiency(const RunCosts& costs, const Network& network, double efficiency, int most = 10'000);

}  // namespace aeroloom::study
