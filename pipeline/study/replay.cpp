#include "pipeline/study/replay.hpp"

#include "pipeline/study/task_schedule.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

namespace aeroloom::study {

namespace {

/// CPU seconds of each rank, added up round by round.
class RankLoads {
public:
  explicit RankLoads(int ranks) : _loads(static_cast<std::size_t>(ranks), 0) {}

  /// Each with all of a group's tasks. Where there are batches ranks wait after each one.
  void add(const TaskGroup& group, const TaskSchedule& schedule) {
    int batches = 1;
    for (const int batch : schedule.batches) batches = std::max(batches, batch + 1);
    for (int batch = 0; batch < batches; ++batch) {
      std::vector<double> round(_loads.size(), 0);
      for (std::size_t t = 0; t < group.tasks.size(); ++t) {
        if (!schedule.batches.empty() && schedule.batches[t] != batch) continue;
        round[static_cast<std::size_t>(schedule.owners[t])] += group.tasks[t].seconds;
        _largest = std::max(_largest, group.tasks[t].seconds);
        _work += group.tasks[t].seconds;
      }
      add_round(round);
    }
  }

  void add_evenly(double seconds) {
    _work += seconds;
    add_round(std::vector<double>(_loads.size(), seconds / static_cast<double>(_loads.size())));
  }

  /// By the bytes of pieces, where they are.
  void add_by_pieces(double seconds, const Scheduler& scheduler) {
    double bytes = 0;
    for (const auto& [number, piece] : scheduler.pieces()) bytes += piece.bytes;
    if (bytes <= 0) return add_evenly(seconds);
    std::vector<double> round(_loads.size(), 0);
    for (const auto& [number, piece] : scheduler.pieces()) {
      const double of_piece = seconds * piece.bytes / bytes;
      round[static_cast<std::size_t>(piece.owner)] += of_piece;
      _largest = std::max(_largest, of_piece);
    }
    _work += seconds;
    add_round(round);
  }

  double busiest() const { return *std::max_element(_loads.begin(), _loads.end()); }
  /// With ranks waiting for each other after each round.
  double in_rounds() const { return _in_rounds; }
  double work() const { return _work; }
  double largest() const { return _largest; }

private:
  void add_round(const std::vector<double>& round) {
    for (std::size_t r = 0; r < round.size(); ++r) _loads[r] += round[r];
    _in_rounds += *std::max_element(round.begin(), round.end());
  }

  std::vector<double> _loads;
  double _in_rounds = 0, _work = 0, _largest = 0;
};

/// Bytes of pieces on the rank with most, over the mean.
double spread_of_bytes(const Scheduler& scheduler, int ranks) {
  std::vector<double> of_ranks(static_cast<std::size_t>(ranks), 0);
  double all = 0;
  for (const auto& [number, piece] : scheduler.pieces()) {
    of_ranks[static_cast<std::size_t>(piece.owner)] += piece.bytes;
    all += piece.bytes;
  }
  return all > 0 ? *std::max_element(of_ranks.begin(), of_ranks.end()) * ranks / all : 1;
}

/// Memory that no number of ranks makes less: the least that any stage after the geometry takes.
double floor_of(const RunCosts& costs) {
  double least = 0;
  for (const StageCosts& stage : costs.stages) {
    if (stage.name == "start" || stage.name == "geometry") continue;
    if (least == 0 || stage.own_bytes < least) least = stage.own_bytes;
  }
  return least;
}

double largest_child(const StageCosts& stage) {
  double largest = 0;
  for (const TaskGroup& group : stage.groups)
    for (const TaskCost& task : group.tasks) largest = std::max(largest, task.child_bytes);
  return largest;
}

double bytes_on(const RunCosts& costs, const StageCosts& stage, int ranks, double spread) {
  if (stage.name == "start" || stage.name == "geometry") return stage.own_bytes;
  const double constant = floor_of(costs) + largest_child(stage);
  const double distributed = std::max(0.0, stage.own_bytes - constant) * costs.ranks;
  return std::min(constant, stage.own_bytes) + distributed / ranks * spread;
}

StagePrediction replay(const StageCosts& stage, const RunCosts& costs, int ranks, const Network& network,
                       Scheduler& scheduler) {
  RankLoads loads(ranks);
  int round = -1;
  for (const TaskGroup& group : stage.groups) {
    loads.add(group, scheduler.schedule(group, group.round == round));
    round = group.round;
  }
  const bool by_pieces = goes_by_pieces(stage.name) && !scheduler.pieces().empty();
  by_pieces ? loads.add_by_pieces(stage.divisible, scheduler) : loads.add_evenly(stage.divisible);
  const double mean = loads.work() / ranks, at_least = std::max(mean, loads.largest());
  const double others = (ranks - 1.0) / ranks;
  StagePrediction result;
  result.name = stage.name;
  result.busy_seconds = stage.serial + stage.repeated + loads.busiest();
  Losses& losses = result.losses;
  losses.serial = stage.serial * others;
  losses.repeated = stage.repeated * others;
  losses.granularity = at_least - mean;
  losses.imbalance = std::max(0.0, loads.busiest() - at_least);
  losses.waiting = std::max(0.0, loads.in_rounds() - loads.busiest());
  losses.communication = exchange_seconds(stage.exchanges, costs.ranks, ranks, network);
  result.seconds = stage.serial + stage.repeated + loads.in_rounds() + losses.communication;
  result.bytes = bytes_on(costs, stage, ranks, by_pieces ? spread_of_bytes(scheduler, ranks) : 1);
  return result;
}

double one_rank_seconds(const RunCosts& costs) {
  double seconds = 0;
  for (const StageCosts& stage : costs.stages) {
    seconds += stage.serial + stage.repeated + stage.divisible;
    for (const TaskGroup& group : stage.groups)
      for (const TaskCost& task : group.tasks) seconds += task.seconds;
  }
  return seconds;
}

/// No number of ranks above can have the efficiency: all of them do what is serial or repeated.
int most_ranks_possible(const RunCosts& costs, double efficiency, int most) {
  double constant = 0;
  for (const StageCosts& stage : costs.stages) constant += stage.serial + stage.repeated;
  if (constant <= 0) return most;
  return static_cast<int>(std::min<double>(most, one_rank_seconds(costs) / (efficiency * constant) + 1));
}

}  // namespace

Losses& Losses::operator+=(const Losses& more) {
  serial += more.serial;
  repeated += more.repeated;
  granularity += more.granularity;
  imbalance += more.imbalance;
  communication += more.communication;
  waiting += more.waiting;
  return *this;
}

Prediction predict(const RunCosts& costs, int ranks, const Network& network) {
  if (ranks < 1 || ranks > most_ranks_predicted)
    throw std::invalid_argument(
        fmt::format("{} ranks: from 1 to {} can be predicted", ranks, most_ranks_predicted));
  if (!(network.latency >= 0) || !(network.bandwidth > 0))
    throw std::invalid_argument("a network needs a latency of 0 s or more and a bandwidth above 0 bytes/s");
  Prediction prediction;
  prediction.ranks = ranks;
  prediction.one_rank_seconds = one_rank_seconds(costs);
  Scheduler scheduler(ranks);
  for (const StageCosts& stage : costs.stages) {
    const StagePrediction& made =
        prediction.stages.emplace_back(replay(stage, costs, ranks, network, scheduler));
    prediction.seconds += made.seconds;
    prediction.busy_seconds += made.busy_seconds;
    prediction.losses += made.losses;
    prediction.bytes = std::max(prediction.bytes, made.bytes);
  }
  return prediction;
}

int ranks_at_efficiency(const RunCosts& costs, const Network& network, double efficiency, int most) {
  constexpr int steps_of_halving = 64;  // the answer is right to 1.6 %
  for (int ranks = most_ranks_possible(costs, efficiency, most); ranks > 1;
       ranks -= std::max(1, ranks / steps_of_halving)) {
    if (predict(costs, ranks, network).efficiency() >= efficiency) return ranks;
  }
  return 1;
}

}  // namespace aeroloom::study
