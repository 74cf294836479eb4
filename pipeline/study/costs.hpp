/// The costs of one run, by stages and by tasks: what a replay on other numbers of ranks goes by.
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

/// CPU seconds, bytes; loads in the unit of the kind.
struct TaskCost {
  std::int64_t number = 0;
  double predicted = 0;    ///< the load it was scheduled by
  double seconds = 0;      ///< children included
  double burden = 0;       ///< what it counts for when further tasks of its round are scheduled
  double bytes = 0;        ///< of what it made
  double child_bytes = 0;  ///< of the child it ran in
};

/// Tasks of one kind between two exchanges of all ranks.
struct TaskGroup {
  std::optional<parallel::TaskKind> kind;  ///< empty: one that this program does not know
  int round = 0;
  std::vector<TaskCost> tasks = {};  ///< by number
};

/// Exchanges between ranks in one stage: those asked for, and what left its rank.
struct StageExchanges {
  parallel::ExchangeCounts asked;
  parallel::MessageCounts sent;  ///< of all ranks together; nothing in a record of one rank
  double partners = 0;           ///< neighbours of the rank with most; 0: not known
};

/// CPU seconds of all ranks together but for `serial` and `repeated`.
struct StageCosts {
  std::string name;
  double serial = 0;                   ///< of one rank, while the others wait
  double repeated = 0;                 ///< of each rank, all alike
  double divisible = 0;                ///< of no task
  std::vector<TaskGroup> groups = {};  ///< one after another
  StageExchanges exchanges = {};
  double own_bytes = 0;  ///< memory of the largest rank, without what ranks of a node share
};

struct RunCosts {
  int ranks = 1;  ///< of the run
  std::vector<StageCosts> stages;
};

/// From report.json and the text of tasks.csv. Throws std::runtime_error that says what is wrong: a run that
/// failed or that went on from a checkpoint, records of another version, a line that is none.
RunCosts costs_of(const nlohmann::ordered_json& report, std::string_view tasks);

/// The costs of the run in a folder. Throws std::runtime_error as costs_of(), with the name of the file.
RunCosts read_costs(const std::filesystem::path& folder);

/// The costs without those of one stage.
RunCosts without(const RunCosts& costs, std::string_view stage);

}  // namespace aeroloom::study
