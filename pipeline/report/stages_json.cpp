#include "pipeline/report/parts_json.hpp"

#include <algorithm>

namespace aeroloom::report {
namespace {

/// Where there are more ranks, a histogram stands for them.
constexpr std::size_t listed_ranks = 64;
constexpr std::size_t load_bins = 20;

Json load_histogram(const std::vector<double>& of_ranks, double largest) {
  std::vector<std::int64_t> counts(load_bins, 0);
  for (const double seconds : of_ranks) {
    const double place = largest > 0 ? seconds / largest * load_bins : 0;
    ++counts[std::min(load_bins - 1, static_cast<std::size_t>(std::max(0.0, place)))];
  }
  return {{"low", 0}, {"high", largest}, {"counts", counts}};
}

void add_load(Json& stage, const std::vector<double>& of_ranks, double largest) {
  if (of_ranks.size() <= listed_ranks)
    stage["cpu_seconds_by_rank"] = of_ranks;
  else
    stage["cpu_seconds_histogram"] = load_histogram(of_ranks, largest);
}

Json messages_json(const parallel::MessageSummary& messages) {
  return {{"count", messages.count},
          {"count_max", messages.count_max},
          {"bytes", messages.bytes},
          {"bytes_max", messages.bytes_max}};
}

Json exchanges_json(const parallel::ExchangeCounts& exchanges) {
  Json json;
  const auto add = [&](const char* kind, const parallel::Messages& of_kind) {
    json[kind] = {{"count", of_kind.count}, {"bytes", of_kind.bytes}};
  };
  add("broadcast", exchanges.broadcast);
  add("all_gather", exchanges.all_gather);
  add("table", exchanges.table);
  add("gather", exchanges.gather);
  add("reduction", exchanges.reduction);
  add("neighbour", exchanges.neighbour);
  add("rendezvous", exchanges.rendezvous);
  return json;
}

}  // namespace

Json stages_json(const std::vector<parallel::StageSummary>& stages) {
  Json json = Json::array();
  for (const parallel::StageSummary& stage : stages) {
    json.push_back({{"name", stage.name},
                    {"wall_seconds", stage.wall_seconds},
                    {"cpu_seconds_min", stage.cpu_seconds_min},
                    {"cpu_seconds_mean", stage.cpu_seconds_mean},
                    {"cpu_seconds_max", stage.cpu_seconds_max},
                    {"serial_seconds", stage.serial_seconds},
                    {"repeated_seconds", stage.repeated_seconds},
                    {"check_seconds", stage.check_seconds},
                    {"other_seconds", stage.other_seconds},
                    {"waiting_seconds_mean", stage.waiting_seconds_mean},
                    {"waiting_seconds_max", stage.waiting_seconds_max},
                    {"pieces", stage.pieces},
                    {"peak_rss_bytes_max", stage.peak_resident_bytes_max},
                    {"peak_rss_bytes_sum", stage.peak_resident_bytes_sum},
                    {"peak_own_bytes_max", stage.peak_own_bytes_max},
                    {"peak_own_bytes_sum", stage.peak_own_bytes_sum},
                    {"messages",
                     {{"collective", messages_json(stage.collective)},
                      {"neighbour", messages_json(stage.neighbour)},
                      {"rendezvous", messages_json(stage.rendezvous)}}},
                    {"exchanges", exchanges_json(stage.exchanges)}});
    add_load(json.back(), stage.cpu_seconds_of_ranks, stage.cpu_seconds_max);
  }
  return json;
}

}  // namespace aeroloom::report
