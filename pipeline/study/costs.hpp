/// Costs of a recorded run by stages and tasks, for its replay on other numbers of ranks.
#pragma once

#include "parallel/communication/message_counts.hpp"
#include "parallel/observation/task_kind.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace aeroloom::study {

/// CPU seconds and bytes; loads in the unit of the kind.
struct TaskCost {
  std::int64_t number = 0;
  double predicted = 0;    ///< load used for scheduling
  double seconds = 0;      ///< child processes included
  double burden = 0;       ///< load that counts when later tasks of the round are scheduled
  double bytes = 0;        ///< of its result
  double child_bytes = 0;  ///< of its child process
};

/// Tasks of one kind between two exchanges of all ranks.
struct TaskGroup {
  std::optional<parallel::TaskKind> kind;  ///< empty: a kind unknown to this program
  int round = 0;
  std::vector<TaskCost> tasks = {};  ///< by number
};

/// Messages of one stage: exchanges called, and messages sent.
struct StageExchanges {
  parallel::ExchangeCounts asked;
  parallel::MessageCounts sent;  ///< of all ranks together; empty in a record of one rank
  double partners = 0;           ///< neighbours of the rank with most; 0: unknown
};

/// A stage. CPU seconds are of all ranks together, except `serial` and `repeated`.
struct StageCosts {
  std::string name;
  double serial = 0;                   ///< of one rank while the others wait
  double repeated = 0;                 ///< of each rank, equal on all
  double divisible = 0;                ///< outside tasks
  std::vector<TaskGroup> groups = {};  ///< in order
  StageExchanges exchanges = {};
  double own_bytes = 0;  ///< memory of the largest rank, without memory shared by ranks of a node
};

struct RunCosts {
  int ranks = 1;  ///< of the recorded run
  std::vector<StageCosts> stages;
};

/// Reads report.json and the text of tasks.csv. Throws std::runtime_error for a failed or resumed run,
/// another version of the records, or an invalid line.
RunCosts costs_of(const nlohmann::ordered_json& report, std::string_view tasks);

/// The costs of the run in a folder. Throws as costs_of(), with the name of the file.
RunCosts read_costs(const std::filesystem::path& folder);

/// The costs without one stage.
RunCosts without(const RunCosts& costs, std::string_view stage);

}  // namespace aeroloom::study
