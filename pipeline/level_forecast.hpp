/// Predicts the cost of a case at the other levels of the prediction workshops.
#pragma once

#include "pipeline/case/case.hpp"
#include "pipeline/domain/level_findings.hpp"
#include "sizing/choice/levels.hpp"
#include "sizing/field/size_field.hpp"

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {

struct LevelForecast {
  sizing::Level level = sizing::Level::a;
  sizing::PredictedCounts counts;
  double seconds = 0;  ///< of one core
  double bytes = 0;    ///< of memory, all ranks together
};

/// Forecasts for all levels of the kind, from the counts at one: triangles scale with the square of the
/// levels' factors, tetrahedra with the cube. Sizes given by the user do not scale, so costs of finer levels
/// are overestimated.
std::vector<LevelForecast> forecast_levels(sizing::Level level, const sizing::PredictedCounts& counted,
                                           const cases::SizingRequest& request, int ranks);

/// Reference lengths and a table of trailing edges.
std::string describe(const domain::LevelFindings& found);
nlohmann::ordered_json to_json(const domain::LevelFindings& found);

/// A table; empty without levels.
std::string describe(const std::vector<LevelForecast>& levels);
nlohmann::ordered_json to_json(const std::vector<LevelForecast>& levels);

}  // namespace aeroloom::pipeline
