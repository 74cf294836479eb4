/// Carries a study out on this machine, or within a job: one run after another, what is done already left
/// out.
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

/// The prediction of `check` for a case.
struct CaseForecast {
  double tetrahedra = 0, seconds = 0, bytes = 0;
};

/// Of the case of a study with some settings more. Throws std::runtime_error with what `check` says where it
/// fails.
CaseForecast forecast_case(const StudyOptions& options, const std::vector<std::string>& settings);

/// The size that a case asks for: a target, or lengths that hold.
struct CaseSize {
  std::optional<double> target;
  std::vector<std::pair<std::string, double>> lengths;  ///< keys and values, without a target
};

/// Settings by which each number of ranks gets as many elements a rank as the smallest: the target grows, or
/// all lengths shrink by one factor that is found by forecasts. Throws as forecast_case.
std::vector<WeakScale> scale_weakly(const StudyOptions& options, const CaseSize& size,
                                    const std::function<void(const std::string&)>& tell);

/// The words that start a run, without a launcher.
std::vector<std::string> command_of(const StudyOptions& options, const RunSpec& run);

/// Starts what has not ended well yet. A run that fails is told of and leaves the others to go on. Files of a
/// mesh go once its hash is known, unless `keep`. Throws std::runtime_error where marks cannot be written.
void carry_out(const StudyRecord& record, const Launcher& launcher, bool keep,
               const std::function<void(const std::string&)>& tell);

}  // namespace aeroloom::study
