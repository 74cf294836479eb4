/// Predictions to look at: a table for a terminal, prediction.json, prediction.csv.
#pragma once

#include "pipeline/study/replay.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::study {

/// The efficiency that is asked for of many ranks.
inline constexpr double wanted_efficiency = 0.8;

/// How many ranks work with wanted_efficiency, and what they need.
struct WorthwhileRanks {
  int ranks = 1;
  double seconds = 0;
  double bytes_per_rank = 0;       ///< of the largest rank
  int ranks_without_geometry = 1;  ///< where reading and preparing the CAD does not count
};
WorthwhileRanks worthwhile_ranks(const RunCosts& costs, const Network& network);

/// All that a prediction tells.
struct Forecasts {
  std::string record;  ///< the folder of the run
  int recorded_ranks = 1;
  Network network;
  std::vector<Prediction> predictions;  ///< by ranks
  WorthwhileRanks worthwhile;
};
/// Throws as predict().
Forecasts forecast_ranks(const RunCosts& costs, const std::string& record, const std::vector<int>& ranks,
                         const Network& network);

nlohmann::ordered_json to_json(const WorthwhileRanks& worthwhile, const Network& network);
/// Keys are stable within a schema_version.
nlohmann::ordered_json prediction_json(const Forecasts& forecasts);
/// A line for each number of ranks and stage, and one for all stages.
std::string prediction_csv(const Forecasts& forecasts);
/// Where the time goes: of each number of ranks in all, of one of them by stages.
std::string prediction_text(const Forecasts& forecasts);

}  // namespace aeroloom::study
