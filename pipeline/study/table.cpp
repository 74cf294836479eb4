#include "pipeline/study/table.hpp"

#include "pipeline/study/processor_use.hpp"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace aeroloom::study {

namespace {

constexpr int json_version = 1;

double seconds_of(const RunResult& run, bool by_cpu) {
  return by_cpu ? run.figures->busy : run.figures->wall;
}

/// All of one series on one number of ranks.
SeriesRow make_row(const StudyRecord& record, std::vector<const RunResult*> runs, const Machine& machine) {
  const RunSpec& spec = runs.front()->spec;
  SeriesRow row;
  row.series = spec.series;
  row.ranks = spec.ranks;
  row.nodes = nodes_for(spec.ranks, record.options.ranks_per_node);
  row.by_cpu = spec.ranks > machine.processors * row.nodes;
  row.planned = static_cast<int>(runs.size());
  row.failed = static_cast<int>(std::count_if(
      runs.begin(), runs.end(), [](const RunResult* run) { return run->marks.state == RunState::failed; }));
  runs.erase(std::remove_if(runs.begin(), runs.end(), [](const RunResult* run) { return !run->figures; }),
             runs.end());
  row.ended = static_cast<int>(runs.size());
  if (runs.empty()) return row;
  std::stable_sort(runs.begin(), runs.end(), [&](const RunResult* a, const RunResult* b) {
    return seconds_of(*a, row.by_cpu) < seconds_of(*b, row.by_cpu);
  });
  const RunFigures &lower = *runs[(runs.size() - 1) / 2]->figures, &upper = *runs[runs.size() / 2]->figures;
  row.median = runs.size() % 2 == 1 ? lower : mean_of(lower, upper);
  for (const RunResult* run : runs)
    if (const auto& beside = run->marks.beside) row.beside = std::max(row.beside.value_or(0), *beside);
  row.least = seconds_of(*runs.front(), row.by_cpu);
  row.most = seconds_of(*runs.back(), row.by_cpu);
  return row;
}

/// The clock against the clock, CPU against CPU.
double times_as_fast(const SeriesRow& row, const SeriesRow& reference) {
  const double seconds = row.seconds();
  const double reference_seconds = row.by_cpu ? reference.median.busy : reference.median.wall;
  return seconds > 0 ? reference_seconds / seconds : 0;
}

void compare(std::vector<SeriesRow>& rows) {
  const auto first_of = [&](Series series) {
    return std::find_if(rows.begin(), rows.end(),
                        [&](const SeriesRow& row) { return row.series == series && row.ended > 0; });
  };
  const auto serial = first_of(Series::serial), strong = first_of(Series::strong),
             weak = first_of(Series::weak);
  for (SeriesRow& row : rows) {
    if (row.ended == 0) continue;
    if (row.series == Series::strong) {
      if (serial != rows.end()) row.speedup = times_as_fast(row, *serial);
      row.speedup_of_series = strong->ranks * times_as_fast(row, *strong);
      row.efficiency = (serial != rows.end() ? row.speedup : row.speedup_of_series) / row.ranks;
    } else if (row.series == Series::weak) {
      const double first = weak->median.rate(weak->ranks, row.by_cpu);
      row.efficiency = row.median.rate(row.ranks, row.by_cpu) / first;
      row.speedup_of_series = row.efficiency * row.ranks;
    } else {
      row.speedup = row.speedup_of_series = row.efficiency = 1;
    }
  }
}

Json row_json(const SeriesRow& row) {
  Json json{{"series", name_of(row.series)},
            {"ranks", row.ranks},
            {"nodes", row.nodes},
            {"runs", row.planned},
            {"ended", row.ended},
            {"failed", row.failed},
            {"judged_by", row.by_cpu ? "cpu" : "wall"}};
  if (row.ended == 0) return json;
  const RunFigures& median = row.median;
  json.update(Json{{"seconds", row.seconds()},
                   {"seconds_min", row.least},
                   {"seconds_max", row.most},
                   {"busy_beside", row.beside ? Json(*row.beside) : Json()},
                   {"wall_seconds", median.wall},
                   {"busy_cpu_seconds", median.busy},
                   {"serial_cpu_seconds", median.serial},
                   {"waiting_seconds", median.waiting},
                   {"speedup", row.speedup > 0 ? Json(row.speedup) : Json()},
                   {"speedup_of_series", row.speedup_of_series},
                   {"efficiency", row.efficiency},
                   {"imbalance", median.imbalance},
                   {"tetrahedra", median.tetrahedra},
                   {"tetrahedra_per_second_and_core", median.rate(row.ranks, row.by_cpu)},
                   {"memory_of_rank_bytes", median.memory_of_rank},
                   {"memory_of_all_bytes", median.memory_of_all},
                   {"hash", median.hash}});
  Json& stages = json["stages"] = Json::array();
  for (const StageFigures& stage : median.stages)
    stages.push_back({{"name", stage.name},
                      {"wall_seconds", stage.wall},
                      {"busy_cpu_seconds", stage.busy},
                      {"serial_cpu_seconds", stage.serial},
                      {"waiting_seconds", stage.waiting},
                      {"imbalance", stage.tasks_mean > 0 ? stage.tasks_max / stage.tasks_mean : 1}});
  return json;
}

Json run_json(const RunResult& run) {
  Json json{{"name", run.spec.name()},
            {"series", name_of(run.spec.series)},
            {"ranks", run.spec.ranks},
            {"repeat", run.spec.repeat},
            {"settings", run.spec.settings},
            {"state", name_of(run.marks.state)},
            {"attempts", run.marks.attempts},
            {"exit_code", run.marks.state == RunState::ended || run.marks.state == RunState::failed
                              ? Json(run.marks.code)
                              : Json()},
            {"host", run.marks.host},
            {"seconds_from_start", run.marks.seconds},
            {"busy_beside", run.marks.beside ? Json(*run.marks.beside) : Json()},
            {"said", run.failure}};
  if (run.figures)
    json.update(Json{{"wall_seconds", run.figures->wall},
                     {"busy_cpu_seconds", run.figures->busy},
                     {"tetrahedra", run.figures->tetrahedra},
                     {"hash", run.figures->hash}});
  return json;
}

}  // namespace

std::vector<SeriesRow> make_rows(const StudyRecord& record, const std::vector<RunResult>& runs,
                                 const Machine& machine) {
  std::map<std::pair<Series, int>, std::vector<const RunResult*>> groups;
  for (const RunResult& run : runs) groups[{run.spec.series, run.spec.ranks}].push_back(&run);
  std::vector<SeriesRow> rows;
  rows.reserve(groups.size());
  for (auto& [key, group] : groups) rows.push_back(make_row(record, std::move(group), machine));
  compare(rows);
  return rows;
}

Json study_json(const StudyRecord& record, const std::vector<RunResult>& runs,
                const std::vector<SeriesRow>& rows, const Machine& machine) {
  Json json{{"schema_version", json_version},
            {"case", record.options.case_file},
            {"overrides", record.options.overrides},
            {"versions", record.versions},
            {"input",
             {{"geometry", record.geometry.hash.empty() ? Json() : Json(record.geometry.hash)},
              {"network", record.network.hash.empty() ? Json() : Json(record.network.hash)}}},
            {"ranks_per_node", record.options.ranks_per_node},
            {"machine", machine.json()}};
  Json& table = json["rows"] = Json::array();
  for (const SeriesRow& row : rows) table.push_back(row_json(row));
  Json& list = json["runs"] = Json::array();
  for (const RunResult& run : runs) list.push_back(run_json(run));
  json["subject"] = record.subject;
  return json;
}

std::string study_csv(const std::vector<RunResult>& runs) {
  std::vector<std::string> stages;
  for (const RunResult& run : runs) {
    if (!run.figures) continue;
    for (const StageFigures& stage : run.figures->stages)
      if (std::find(stages.begin(), stages.end(), stage.name) == stages.end()) stages.push_back(stage.name);
  }
  std::string text =
      "series,ranks,repeat,state,exit_code,tetrahedra,hash,wall_seconds,busy_cpu_seconds,serial_cpu_seconds,"
      "waiting_seconds,imbalance,memory_of_rank_bytes,memory_of_all_bytes";
  for (const std::string& stage : stages)
    text += fmt::format(",{0}_wall_seconds,{0}_busy_cpu_seconds", stage);
  text += '\n';
  for (const RunResult& run : runs) {
    text += fmt::format("{},{},{},{},{}", name_of(run.spec.series), run.spec.ranks, run.spec.repeat,
                        name_of(run.marks.state), run.marks.code);
    if (!run.figures) {
      text += std::string(9 + 2 * stages.size(), ',') + '\n';
      continue;
    }
    const RunFigures& figures = *run.figures;
    text += fmt::format(",{:.0f},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.4f},{:.0f},{:.0f}", figures.tetrahedra,
                        figures.hash, figures.wall, figures.busy, figures.serial, figures.waiting,
                        figures.imbalance, figures.memory_of_rank, figures.memory_of_all);
    for (const std::string& name : stages) {
      const auto stage = std::find_if(figures.stages.begin(), figures.stages.end(),
                                      [&](const StageFigures& each) { return each.name == name; });
      text += stage == figures.stages.end() ? ",," : fmt::format(",{:.4f},{:.4f}", stage->wall, stage->busy);
    }
    text += '\n';
  }
  return text;
}

std::string study_text(const std::vector<SeriesRow>& rows) {
  std::string text = fmt::format("{:<7} {:>6} {:>6} {:>9} {:>9} {:>10} {:>9} {:>9} {:>12} {:>11}\n", "series",
                                 "ranks", "runs", "seconds", "speed-up", "efficiency", "imbalance",
                                 "MiB/rank", "tetrahedra", "per s, core");
  bool any_by_cpu = false;
  double beside = 0;
  for (const SeriesRow& row : rows) {
    beside = std::max(beside, row.beside.value_or(0));
    text += fmt::format("{:<7} {:>6} {:>6} ", name_of(row.series), row.ranks,
                        fmt::format("{}/{}", row.ended, row.planned));
    if (row.ended == 0) {
      text += row.failed > 0 ? "failed\n" : "not yet\n";
      continue;
    }
    any_by_cpu = any_by_cpu || row.by_cpu;
    const double speedup = row.speedup > 0 ? row.speedup : row.speedup_of_series;
    text += fmt::format("{:>8.2f}{} {:>9.2f} {:>9.0f}% {:>9.2f} {:>9.0f} {:>12.0f} {:>11.0f}\n",
                        row.seconds(), row.by_cpu ? '*' : ' ', speedup, 100 * row.efficiency,
                        row.median.imbalance, row.median.memory_of_rank / 1048576, row.median.tetrahedra,
                        row.median.rate(row.ranks, row.by_cpu));
  }
  if (any_by_cpu) text += "* more ranks than processors: CPU seconds of the busiest rank\n";
  if (beside > busy_processors)
    text += fmt::format("The machine was busy: other programs used up to {:.1f} processors during a run.\n",
                        beside);
  return text;
}

}  // namespace aeroloom::study
