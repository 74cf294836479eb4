#include "pipeline/study/results.hpp"

#include "pipeline/study/text_files.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <initializer_list>
#include <set>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>
#include <unistd.h>

namespace aeroloom::study {

namespace fs = std::filesystem;

namespace {

constexpr const char* marks_name = "marks";

double seconds_since_epoch() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

void add_mark(const fs::path& folder, const std::string& line) {
  fs::create_directories(folder);
  std::ofstream file(folder / marks_name, std::ios::app);
  file << line << '\n';
  file.close();
  if (!file) throw std::runtime_error(fmt::format("cannot write '{}'", (folder / marks_name).string()));
}

/// The last line that says something.
std::string last_words(const fs::path& log) {
  std::ifstream file(log);
  std::string line, error, last;
  while (std::getline(file, line)) {
    if (line.starts_with("error: ")) error = line;
    if (line.find_first_not_of(" \t-") != std::string::npos) last = line;
  }
  return error.empty() ? last : error;
}

double number_at(const Json& json, const char* key) {
  const auto found = json.find(key);  // the end, in what is no object
  return found != json.end() && found->is_number() ? found->get<double>() : 0;
}

std::string text_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

StageFigures stage_figures(const Json& stage) {
  StageFigures figures;
  figures.name = text_at(stage, "name");
  figures.wall = number_at(stage, "wall_seconds");
  figures.tasks_max = number_at(stage, "cpu_seconds_max");
  figures.tasks_mean = number_at(stage, "cpu_seconds_mean");
  figures.busy = figures.tasks_max + number_at(stage, "check_seconds") + number_at(stage, "other_seconds");
  figures.serial = number_at(stage, "serial_seconds");
  figures.waiting = number_at(stage, "waiting_seconds_mean");
  return figures;
}

const Json& object_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_object()) throw std::runtime_error(fmt::format("has no '{}'", key));
  return *found;
}

/// The report as far as it is one, and the figures if it is that of a finished run.
void look_at_report(const fs::path& file, RunResult& run, std::string& fault) {
  if (!fs::exists(file)) return;
  Json report;
  try {
    report = read_json(file);
    if (text_at(report, "status") == "ok") run.figures = figures_of(report);
    fault = "with a report that tells of a failure";
  } catch (const std::runtime_error& error) {
    fault = fmt::format("with a report that is not that of a finished run: {}", error.what());
  }
  if (!report.is_object()) return;
  run.reported_code = static_cast<int>(number_at(report, "exit_code"));
  if (const auto failure = report.find("failure"); failure != report.end() && failure->is_object())
    run.failure = fmt::format("stage {}: {}", text_at(*failure, "stage"), text_at(*failure, "message"));
}

}  // namespace

std::string_view name_of(RunState state) {
  constexpr std::array<std::string_view, 5> names{"planned", "queued", "begun", "ended", "failed"};
  return names.at(static_cast<std::size_t>(state));
}

std::string host_name() {
  std::array<char, 256> name{};
  ::gethostname(name.data(), name.size() - 1);
  return name.data();
}

void mark_begin(const fs::path& folder, std::int64_t process) {
  add_mark(folder, fmt::format("begin {:.3f} {} {}", seconds_since_epoch(), process, host_name()));
}

void mark_end(const fs::path& folder, int code, std::optional<double> beside) {
  add_mark(folder, fmt::format("end {:.3f} {}{}", seconds_since_epoch(), code,
                               beside ? fmt::format(" {:.2f}", *beside) : ""));
}

RunMarks read_marks(const fs::path& folder) {
  RunMarks marks;
  std::ifstream file(folder / marks_name);
  double first = 0, at = 0;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    if (!(words >> kind >> at)) continue;
    if (kind == "begin" && words >> marks.process) {
      words >> marks.host;
      marks.state = RunState::begun;
      if (marks.attempts++ == 0) first = at;
    } else if (kind == "end" && words >> marks.code) {
      marks.state = marks.code == 0 ? RunState::ended : RunState::failed;
      marks.seconds = at - first;
      double beside = 0;
      marks.beside = words >> beside ? std::optional(beside) : std::nullopt;
    }
  }
  return marks;
}

RunResult result_of(const fs::path& directory, const RunSpec& spec) {
  const fs::path folder = folder_of(directory, spec);
  RunResult run{spec, read_marks(folder), {}, {}};
  std::string fault = "without a report";
  look_at_report(folder / "report.json", run, fault);
  if (run.marks.state == RunState::ended && run.figures) {
    run.failure.clear();
    return run;
  }
  run.figures.reset();  // of an earlier attempt
  if (run.marks.state == RunState::ended) {
    run.marks.state = RunState::failed;
    if (run.failure.empty())
      run.failure = fmt::format("ended with 0 {}; its log: {}", fault, last_words(folder / "log"));
  }
  if (run.marks.state == RunState::failed && run.failure.empty()) run.failure = last_words(folder / "log");
  run.failure = run.failure.substr(0, run.failure.find('\n'));
  return run;
}

RunFigures figures_of(const Json& report) {
  RunFigures figures;
  const Json& mesh = object_at(report, "mesh");
  const auto stages = report.find("stages");
  if (stages == report.end() || !stages->is_array()) throw std::runtime_error("has no 'stages'");
  figures.wall = number_at(report, "wall_seconds");
  figures.tetrahedra = number_at(mesh, "tetrahedra");
  figures.hash = text_at(mesh, "hash");
  if (const auto input = report.find("input"); input != report.end())
    figures.input_hash = text_at(*input, "hash");
  double tasks_max = 0, tasks_mean = 0;
  for (const Json& each : *stages) {
    figures.stages.push_back(stage_figures(each));
    const StageFigures& stage = figures.stages.back();
    figures.busy += stage.busy;
    figures.serial += stage.serial;
    figures.waiting += stage.waiting;
    tasks_max += stage.tasks_max;
    tasks_mean += stage.tasks_mean;
    figures.memory_of_rank = std::max(figures.memory_of_rank, number_at(each, "peak_rss_bytes_max"));
    figures.memory_of_all = std::max(figures.memory_of_all, number_at(each, "peak_rss_bytes_sum"));
  }
  if (tasks_mean > 0) figures.imbalance = tasks_max / tasks_mean;
  return figures;
}

namespace {

template <class Figures>
void average(Figures& into, const Figures& with, std::initializer_list<double Figures::*> parts) {
  for (const auto part : parts) into.*part = 0.5 * (into.*part + with.*part);
}

}  // namespace

RunFigures mean_of(const RunFigures& one, const RunFigures& other) {
  RunFigures mean = one;
  average(mean, other,
          {&RunFigures::wall, &RunFigures::busy, &RunFigures::serial, &RunFigures::waiting,
           &RunFigures::imbalance, &RunFigures::memory_of_rank, &RunFigures::memory_of_all});
  for (StageFigures& stage : mean.stages) {
    const auto same = std::find_if(other.stages.begin(), other.stages.end(),
                                   [&](const StageFigures& each) { return each.name == stage.name; });
    if (same == other.stages.end()) continue;
    average(stage, *same,
            {&StageFigures::wall, &StageFigures::busy, &StageFigures::serial, &StageFigures::waiting,
             &StageFigures::tasks_mean, &StageFigures::tasks_max});
  }
  return mean;
}

std::vector<RunResult> collect_runs(const StudyRecord& record,
                                    const std::map<std::string, std::string>& queue) {
  std::vector<RunResult> results;
  for (const RunSpec& spec : record.runs) {
    RunResult run = result_of(record.options.directory, spec);
    if (const auto state = queue.find(spec.name());
        state != queue.end() && run.marks.state != RunState::ended) {
      if (run.marks.state == RunState::planned) run.marks.state = RunState::queued;
      run.failure += (run.failure.empty() ? "" : "; ") + fmt::format("queue: {}", state->second);
    }
    results.push_back(std::move(run));
  }
  return results;
}

const RunResult* recorded_run(const std::vector<RunResult>& runs) {
  std::vector<const RunResult*> candidates;
  for (const RunResult& run : runs)
    if (run.spec.series == Series::strong && run.figures) candidates.push_back(&run);
  if (candidates.empty()) return nullptr;
  std::stable_sort(candidates.begin(), candidates.end(), [](const RunResult* a, const RunResult* b) {
    return a->spec.ranks != b->spec.ranks ? a->spec.ranks < b->spec.ranks
                                          : a->figures->busy < b->figures->busy;
  });
  const int least = candidates.front()->spec.ranks;
  const auto end = std::find_if(candidates.begin(), candidates.end(),
                                [&](const RunResult* run) { return run->spec.ranks != least; });
  return candidates[static_cast<std::size_t>(end - candidates.begin() - 1) / 2];
}

std::vector<int> ranks_to_predict(const std::vector<RunResult>& runs) {
  std::set<int> ranks;
  for (const RunResult& run : runs)
    if (run.spec.series == Series::strong) ranks.insert(run.spec.ranks);
  if (ranks.empty()) return {};
  constexpr int farthest_factor =
      4;  // over the most ranks that were run: farther nothing checks what is predicted
  const int most = farthest_factor * *ranks.rbegin();
  for (int n = 1; n <= most; n *= 2) ranks.insert(n);
  return {ranks.begin(), ranks.end()};
}

bool is_done(const StudyRecord& record, const RunResult& run) {
  const std::string& planned = record.geometry.hash;
  return run.figures &&
         (planned.empty() || run.figures->input_hash.empty() || run.figures->input_hash == planned);
}

void require_geometry(const StudyRecord& record, const std::vector<RunResult>& runs) {
  for (const RunResult& run : runs) {
    if (!run.figures || is_done(record, run)) continue;
    throw std::runtime_error(fmt::format(
        "run '{}' has read other geometry than the study has: '{}' or a file beside it was changed in "
        "between. Remedy: restore it, and make that run again by the command of the study",
        run.spec.name(), record.geometry.name));
  }
}

void require_equal_meshes(const std::vector<RunResult>& runs) {
  std::map<std::string, const RunResult*> first_of;
  const RunResult* first_read = nullptr;
  for (const RunResult& run : runs) {
    if (!run.figures) continue;
    if (first_read == nullptr) first_read = &run;
    if (run.figures->input_hash != first_read->figures->input_hash) {
      throw std::runtime_error(
          fmt::format("runs '{}' and '{}' read different geometry: it was changed in between",
                      first_read->spec.name(), run.spec.name()));
    }
    // A strong series has one mesh on all ranks; a weak one another on each number of ranks.
    const std::string key = run.spec.series == Series::weak ? fmt::format("weak {}", run.spec.ranks)
                                                            : std::string(name_of(run.spec.series));
    const auto [place, is_first] = first_of.emplace(key, &run);
    if (is_first || place->second->figures->hash == run.figures->hash) continue;
    throw std::runtime_error(fmt::format(
        "runs '{}' and '{}' of one configuration made different meshes: {} and {}. This is a bug of the "
        "program: "
        "please report it",
        place->second->spec.name(), run.spec.name(), place->second->figures->hash, run.figures->hash));
  }
}

void remove_meshes(const fs::path& folder) {
  const std::set<std::string> kept{"report.json", "report.html", "marks", "log", "tasks.csv"};
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (kept.count(entry.path().filename().string()) == 0) fs::remove_all(entry.path());
}

}  // namespace aeroloom::study
