/// Carries out a study on this machine or within a job. Runs follow one another; finished ones are skipped.
#pragma once

#include "pipeline/study/launcher.hpp"
#include "pipeline/study/machine.hpp"
#include "pipeline/study/plan.hpp"

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace aeroloom::study {

/// The prediction of `aeroloom check` for a case.
struct CaseForecast {
  double tetrahedra = 0, seconds = 0, bytes = 0;
};

/// Predicts the study's case with additional settings. Throws std::runtime_error with the message of `check`
/// if that fails.
CaseForecast forecast_case(const StudyOptions& options, const std::vector<std::string>& settings);

/// The size that a case asks for: a target, or fixed lengths.
struct CaseSize {
  std::optional<double> target;
  std::vector<std::pair<std::string, double>> lengths;  ///< keys and values, if there is no target
};

/// Settings with equal elements per rank for each number of ranks: a larger target, or lengths times one
/// factor found by forecasts. Throws as forecast_case().
std::vector<WeakScale> scale_weakly(const StudyOptions& options, const CaseSize& size,
                                    const std::function<void(const std::string&)>& log);

/// The words of the command for a run, without launcher. Throws as quoted_for_key() for the folder of
/// results.
std::vector<std::string> command_of(const StudyOptions& options, const RunSpec& run);

/// Starts all runs that have not succeeded. Failures are logged and do not stop the series. Mesh files are
/// removed once their hash is known, unless `keep`. Throws std::runtime_error if marks cannot be written.
void carry_out(const StudyRecord& record, const Launcher& launcher, bool keep,
               const std::function<void(const std::string&)>& log);

}  // namespace aeroloom::study
