#include "pipeline/study/series.hpp"

#include "pipeline/study/processor_use.hpp"
#include "pipeline/study/results.hpp"
#include "pipeline/study/text_files.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::study {

namespace fs = std::filesystem;

namespace {

constexpr double near_enough = 0.02;  // of the elements that a rank is to have
constexpr int most_forecasts = 8;     // each takes as long as the stage of sizes; chosen, not measured
// Of the logarithm of the count over that of lengths: a surface's is -2, a volume's -3; outside of the bounds
// it is noise.
constexpr double first_slope = -2.5, steepest_slope = -4, flattest_slope = -1;
constexpr double uneven = 1.25;  // elements per rank over those of the smallest number of ranks

void add_settings(std::vector<std::string>& words, const std::vector<std::string>& settings) {
  for (const std::string& setting : settings) {
    words.emplace_back("--set");
    words.push_back(setting);
  }
}

std::vector<std::string> scaled(const CaseSize& size, double factor) {
  std::vector<std::string> settings;
  for (const auto& [key, value] : size.lengths)
    settings.push_back(fmt::format("{}={:.12g}", key, factor * value));
  return settings;
}

/// Lengths for `wanted` elements: as many are lost per logarithm of length as between the last two forecasts.
std::vector<std::string> find_lengths(const StudyOptions& options, const CaseSize& size, double wanted,
                                      double factor, double made) {
  double slope = first_slope;
  for (int round = 0; round < most_forecasts && std::abs(made / wanted - 1) > near_enough; ++round) {
    const double next = factor * std::exp(std::log(wanted / made) / slope);
    const double then = forecast_case(options, scaled(size, next)).tetrahedra;
    const double measured = std::log(then / made) / std::log(next / factor);
    if (std::isfinite(measured)) slope = std::clamp(measured, steepest_slope, flattest_slope);
    factor = next;
    made = then;
  }
  return scaled(size, factor);
}

}  // namespace

std::vector<std::string> command_of(const StudyOptions& options, const RunSpec& run) {
  std::vector<std::string> words{options.program, "run", options.case_file};
  add_settings(words, options.overrides);
  add_settings(words, run.settings);
  add_settings(words, {"output.directory=" + quoted_for_key(folder_of(options.directory, run).string()),
                       "output.pictures=false"});
  return words;
}

CaseForecast forecast_case(const StudyOptions& options, const std::vector<std::string>& settings) {
  const fs::path folder = options.directory / "runs" / "forecast";
  fs::create_directories(folder);
  std::vector<std::string> words{options.program, "check", options.case_file};
  add_settings(words, options.overrides);
  add_settings(words, settings);
  add_settings(words, {"output.directory=" + quoted_for_key(folder.string())});
  const Ended ended = run_line(fmt::format("exec {}", quoted(words)), folder / "log");
  if (ended.code != 0) {
    throw std::runtime_error(
        fmt::format("the size of the case cannot be predicted, 'aeroloom check' ended with {}:\n{}",
                    ended.code, read_file(folder / "log")));
  }
  const Json json = read_json(folder / "check.json");
  try {
    const auto at = [&](const char* key) { return json.at("forecast").at(key).get<double>(); };
    return {at("tetrahedra"), at("seconds_on_one_core"), at("bytes")};
  } catch (const Json::exception& error) {
    refuse_json(folder / "check.json", "what 'aeroloom check' of this program leaves", error);
  }
}

std::vector<WeakScale> scale_weakly(const StudyOptions& options, const CaseSize& size,
                                    const std::function<void(const std::string&)>& log) {
  std::vector<WeakScale> scales;
  const int least = options.ranks.front();
  const double first = forecast_case(options, {}).tetrahedra;
  if (size.target) {
    for (const int ranks : options.ranks) {
      scales.push_back(
          {ranks, {fmt::format("sizing.target_tetrahedra={:.0f}", *size.target * ranks / least)}});
      const double of_rank =
          forecast_case(options, scales.back().settings).tetrahedra * least / ranks / first;
      if (of_rank < uneven && of_rank > 1 / uneven) continue;
      log(fmt::format(
          "weak series, {} rank(s): {:.2g} times the tetrahedra per rank that {} have, for the size of "
          "features "
          "does not go with the target. Remedy: sizing.minimum and sizing.maximum instead of a target, "
          "which are then scaled",
          ranks, of_rank, least));
    }
    return scales;
  }
  for (const int ranks : options.ranks) {
    scales.push_back({ranks, find_lengths(options, size, first * ranks / least, 1, first)});
    log(fmt::format("weak series, {} rank(s): {}", ranks, fmt::format("{}", scales.back().settings.front())));
  }
  return scales;
}

void carry_out(const StudyRecord& record, const Launcher& launcher, bool keep,
               const std::function<void(const std::string&)>& log) {
  const StudyOptions& options = record.options;
  double load = 0;
  if (std::ifstream("/proc/loadavg") >> load && load > busy_processors)
    log(fmt::format("this machine is busy, its load is {:.1f}: seconds will tell of that, too", load));
  std::size_t number = 0;
  for (const RunSpec& run : record.runs) {
    const fs::path folder = folder_of(options.directory, run);
    const std::string title = fmt::format("[{}/{}] {}", ++number, record.runs.size(), run.name());
    const RunResult before = result_of(options.directory, run);
    if (is_done(record, before)) {
      log(title + ": done before");
      continue;
    }
    if (before.marks.state == RunState::begun && before.marks.host == host_name())
      end_session(static_cast<pid_t>(before.marks.process), options.program);
    fs::create_directories(folder);
    fs::remove(folder / "report.json");  // of an earlier attempt
    const std::string line =
        launcher.line(run.ranks, nodes_for(run.ranks, options.ranks_per_node), command_of(options, run));
    const ProcessorUse use_before = processor_use();
    const Ended ended = run_line(line, folder / "log", [&](pid_t session) { mark_begin(folder, session); });
    mark_end(folder, ended.code, busy_beside(use_before, processor_use(), ended.seconds));
    const RunResult result = result_of(options.directory, run);
    if (result.figures) {
      log(fmt::format("{}: {:.0f} tetrahedra in {:.2f} s, hash {}", title, result.figures->tetrahedra,
                      result.figures->wall, result.figures->hash));
      if (!keep) remove_meshes(folder);
    } else {
      log(fmt::format("{}: failed with code {}, see {}", title, ended.code, (folder / "log").string()));
    }
  }
}

}  // namespace aeroloom::study
