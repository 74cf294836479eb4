/// Writes predictions as text, prediction.json and prediction.csv.
#pragma once

#include "pipeline/study/replay.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::study {

/// The parallel efficiency that counts as good.
inline constexpr double wanted_efficiency = 0.8;

/// The largest number of ranks with wanted_efficiency, and its cost.
struct WorthwhileRanks {
  int ranks = 1;
  double seconds = 0;
  double bytes_per_rank = 0;       ///< of the largest rank
  int ranks_without_geometry = 1;  ///< the same without the time for reading and preparing CAD
};
WorthwhileRanks worthwhile_ranks(const RunCosts& costs, const Network& network);

/// A complete prediction.
struct Forecasts {
  std::string record;  ///< folder of the recorded run
  int recorded_ranks = 1;
  Network network;
  std::vector<Prediction> predictions;  ///< by number of ranks
  WorthwhileRanks worthwhile;
};
/// Throws as predict().
Forecasts forecast_ranks(const RunCosts& costs, const std::string& record, const std::vector<int>& ranks,
                         const Network& network);

nlohmann::ordered_json to_json(const WorthwhileRanks& worthwhile, const Network& network);
/// Keys are stable within a schema_version.
nlohmann::ordered_json prediction_json(const Forecasts& forecasts);
/// One line for each number of ranks and stage, and one for all stages together.
std::string prediction_csv(const Forecasts& forecasts);
/// Where the time goes: totals by number of ranks, and stages for one number of ranks.
std::string prediction_text(const Forecasts& forecasts);

}  // namespace aeroloom::study
