#include "pipeline/study/costs.hpp"

#include "pipeline/study/text_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace aeroloom::study {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view head =
    "rank,stage,kind,number,predicted,cpu_seconds,bytes,child_bytes,round,burden";
constexpr std::size_t columns = 10;

/// Of a line of tasks.csv.
struct TaskLine {
  std::string stage, kind;
  int round = 0;
  TaskCost task;
};

double number_of(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size())
    throw std::runtime_error(fmt::format("'{}' is no number", word));
  return value;
}

TaskLine row_of(std::string_view line) {
  std::array<std::string_view, columns> words;
  std::size_t count = 0;
  for (std::size_t at = 0; at <= line.size(); ++count) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    if (count < columns) words[count] = line.substr(at, end - at);
    at = end + 1;
  }
  if (count != columns) throw std::runtime_error(fmt::format("{} columns where {} were", count, columns));
  TaskLine row{std::string(words[1]), std::string(words[2]), static_cast<int>(number_of(words[8])), {}};
  row.task = {static_cast<std::int64_t>(number_of(words[3])),
              number_of(words[4]),
              number_of(words[5]),
              number_of(words[9]),
              number_of(words[6]),
              number_of(words[7])};
  if (row.task.predicted < 0 || row.task.seconds < 0) throw std::runtime_error("a negative load or time");
  return row;
}

std::vector<TaskLine> task_lines(std::string_view text) {
  std::vector<TaskLine> rows;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (++number == 1) {
      if (line != head)
        throw std::runtime_error("its columns are not those of this version. Remedy: a run by this program");
      continue;
    }
    try {
      if (!line.empty()) rows.push_back(row_of(line));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(fmt::format("line {}: {}", number, error.what()));
    }
  }
  return rows;
}

/// The place of a kind among those of its round; unknown ones come last.
std::size_t order_of(std::optional<parallel::TaskKind> kind) {
  return kind ? static_cast<std::size_t>(*kind) : parallel::task_kinds.size();
}

/// One after another as they wait for each other.
std::vector<TaskGroup> group_tasks(const std::vector<TaskLine>& rows, const std::string& stage) {
  std::map<std::tuple<int, std::size_t, std::string>, TaskGroup> groups;
  for (const TaskLine& row : rows) {
    if (row.stage != stage) continue;
    const std::optional<parallel::TaskKind> kind = parallel::task_kind_called(row.kind);
    TaskGroup& group = groups[{row.round, order_of(kind), row.kind}];
    group.kind = kind;
    group.round = row.round;
    group.tasks.push_back(row.task);
  }
  std::vector<TaskGroup> result;
  for (auto& [key, group] : groups) {
    // Two tasks of one number (pieces of a face) in the order that does not depend on who made them.
    std::stable_sort(group.tasks.begin(), group.tasks.end(), [](const TaskCost& a, const TaskCost& b) {
      return std::tie(a.number, a.predicted) < std::tie(b.number, b.predicted);
    });
    result.push_back(std::move(group));
  }
  return result;
}

StageExchanges exchanges_of(const Json& stage) {
  StageExchanges exchanges;
  const auto read = [](const Json& from, parallel::Messages& to) {
    to = {from.at("count").get<std::int64_t>(), from.at("bytes").get<std::int64_t>()};
  };
  const Json& asked = stage.at("exchanges");
  parallel::ExchangeCounts& counts = exchanges.asked;
  read(asked.at("broadcast"), counts.broadcast);
  read(asked.at("all_gather"), counts.all_gather);
  read(asked.at("table"), counts.table);
  read(asked.at("gather"), counts.gather);
  read(asked.at("reduction"), counts.reduction);
  read(asked.at("neighbour"), counts.neighbour);
  read(asked.at("rendezvous"), counts.rendezvous);
  const Json& sent = stage.at("messages");
  read(sent.at("collective"), exchanges.sent.collective);
  read(sent.at("neighbour"), exchanges.sent.neighbour);
  read(sent.at("rendezvous"), exchanges.sent.rendezvous);
  const double most = sent.at("neighbour").at("count_max").get<double>();
  if (counts.neighbour.count > 0) exchanges.partners = most / static_cast<double>(counts.neighbour.count);
  return exchanges;
}

StageCosts stage_costs(const Json& stage, int ranks, const std::vector<TaskLine>& rows) {
  const auto at = [&](const char* key) { return stage.at(key).get<double>(); };
  StageCosts costs;
  costs.name = stage.at("name").get<std::string>();
  costs.groups = group_tasks(rows, costs.name);
  costs.repeated = at("repeated_seconds");
  costs.serial = std::max(0.0, at("serial_seconds") - costs.repeated);
  double of_tasks = 0;
  for (const TaskGroup& group : costs.groups)
    for (const TaskCost& task : group.tasks) of_tasks += task.seconds;
  const double of_all = at("cpu_seconds_mean") * ranks;
  costs.divisible = std::max(0.0, of_all - costs.serial - costs.repeated * ranks - of_tasks);
  costs.divisible += at("check_seconds") * ranks;
  // Work that every rank repeats has a clock of its own. What is on no clock goes with a rank's part of the
  // mesh: messages packed and unpacked, memory taken and given back. Every rank starts, though.
  const double other = at("other_seconds");
  costs.name == "start" ? costs.repeated += other : costs.divisible += other * ranks;
  costs.exchanges = exchanges_of(stage);
  costs.own_bytes = at("peak_own_bytes_max");
  return costs;
}

}  // namespace

RunCosts costs_of(const Json& report, std::string_view tasks) {
  if (!report.is_object() || !report.contains("stages") || !report.contains("ranks"))
    throw std::runtime_error("this is no report of a run");
  const auto text_of = [](const Json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
  };
  if (!report.contains("status") || text_of(report["status"]) != "ok")
    throw std::runtime_error("the run failed: what it would have cost is not on record");
  if (report.contains("resumed") && !report["resumed"].empty())
    throw std::runtime_error(
        fmt::format("the run took '{}' from a checkpoint, whose cost is not on record. Remedy: a run from "
                    "the beginning",
                    text_of(report["resumed"].front())));
  const std::vector<TaskLine> rows = task_lines(tasks);
  try {
    RunCosts costs;
    costs.ranks = report.at("ranks").get<int>();
    for (const Json& stage : report.at("stages"))
      costs.stages.push_back(stage_costs(stage, costs.ranks, rows));
    return costs;
  } catch (const Json::exception& error) {
    throw std::runtime_error(fmt::format(
        "its stages are not those of this version ({}). Remedy: a run by this program", error.what()));
  }
}

RunCosts read_costs(const std::filesystem::path& folder) {
  const std::filesystem::path report = folder / "report.json", tasks = folder / "tasks.csv";
  if (!std::filesystem::exists(report))
    throw std::runtime_error(
        fmt::format("'{}' has no report.json: it is no output of a run", folder.string()));
  if (!std::filesystem::exists(tasks))
    throw std::runtime_error(
        fmt::format("'{}' has no tasks.csv. Remedy: a run with output.tasks: true, which is the default",
                    folder.string()));
  const Json json = read_json(report);
  std::string text = read_file(tasks);
  try {
    return costs_of(json, text);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("'{}': {}", folder.string(), error.what()));
  }
}

RunCosts without(const RunCosts& costs, std::string_view stage) {
  RunCosts rest = costs;
  std::erase_if(rest.stages, [&](const StageCosts& each) { return each.name == stage; });
  return rest;
}

}  // namespace aeroloom::study
