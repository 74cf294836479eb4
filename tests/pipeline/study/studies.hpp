/// Studies that tests look at, and what their runs would have left.
#pragma once

#include "pipeline/study/results.hpp"
#include "pipeline/study/text_files.hpp"

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace aeroloom::study {

/// A folder of this test that is gone with it.
class StudyFolder {
public:
  explicit StudyFolder(const std::string& name)
      : path(std::filesystem::temp_directory_path() / fmt::format("aeroloom_study_{}_{}", name, ::getpid())) {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
  }
  ~StudyFolder() { std::filesystem::remove_all(path); }
  StudyFolder(const StudyFolder&) = delete;
  StudyFolder& operator=(const StudyFolder&) = delete;

  std::filesystem::path path;
};

inline StudyRecord a_study(const std::filesystem::path& folder, std::vector<int> ranks, int repeats,
                           const std::vector<WeakScale>& weak = {}) {
  StudyRecord record;
  record.options.program = "/opt/aeroloom";
  record.options.case_file = "/cases/wing.yaml";
  record.options.directory = folder;
  record.options.ranks = std::move(ranks);
  record.options.repeats = repeats;
  record.subject = "sizing:\n  minimum: 1\n";
  record.versions = "aeroloom 1";
  record.runs = plan_runs(record.options, weak);
  return record;
}

/// As a run of so many seconds leaves it, in two stages, of which the second halves its CPU with each
/// doubling.
inline void leave_report(const std::filesystem::path& folder, double wall, double tetrahedra,
                         const std::string& hash, double busy = 1) {
  const Json report{{"status", "ok"},
                    {"wall_seconds", wall},
                    {"input", {{"hash", "f00d"}}},
                    {"mesh", {{"tetrahedra", tetrahedra}, {"hash", hash}}},
                    {"stages",
                     {{{"name", "sizing"},
                       {"wall_seconds", 0.25 * wall},
                       {"cpu_seconds_max", 0.2},
                       {"cpu_seconds_mean", 0.2},
                       {"check_seconds", 0.0},
                       {"other_seconds", 0.0},
                       {"serial_seconds", 0.1},
                       {"waiting_seconds_mean", 0.0},
                       {"peak_rss_bytes_max", 1e8},
                       {"peak_rss_bytes_sum", 2e8}},
                      {{"name", "volume"},
                       {"wall_seconds", 0.75 * wall},
                       {"cpu_seconds_max", busy - 0.2},
                       {"cpu_seconds_mean", 0.5 * busy - 0.1},
                       {"check_seconds", 0.0},
                       {"other_seconds", 0.0},
                       {"serial_seconds", 0.0},
                       {"waiting_seconds_mean", 0.5},
                       {"peak_rss_bytes_max", 3e8},
                       {"peak_rss_bytes_sum", 5e8}}}}};
  mark_begin(folder, 1);
  write_file(folder / "report.json", report.dump());
  mark_end(folder, 0);
}

}  // namespace aeroloom::study
