#include "pipeline/study/prediction_files.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>

namespace aeroloom::study {

namespace {

using Json = nlohmann::ordered_json;

constexpr int prediction_version = 1;
constexpr double mebibyte = 1024.0 * 1024;

struct NamedLoss {
  const char* name;
  double Losses::*seconds;
};
constexpr std::array<NamedLoss, 6> named_losses{{{"serial", &Losses::serial},
                                                 {"repeated", &Losses::repeated},
                                                 {"granularity", &Losses::granularity},
                                                 {"imbalance", &Losses::imbalance},
                                                 {"communication", &Losses::communication},
                                                 {"waiting", &Losses::waiting}}};

Json losses_json(const Losses& losses) {
  Json json;
  for (const NamedLoss& loss : named_losses) json[loss.name] = losses.*loss.seconds;
  return json;
}

Json prediction_row(const Prediction& prediction) {
  Json json{{"ranks", prediction.ranks},
            {"seconds", prediction.seconds},
            {"busy_cpu_seconds", prediction.busy_seconds},
            {"speedup", prediction.speedup()},
            {"efficiency", prediction.efficiency()},
            {"memory_of_rank_bytes", prediction.bytes},
            {"losses", losses_json(prediction.losses)}};
  Json& stages = json["stages"] = Json::array();
  for (const StagePrediction& stage : prediction.stages)
    stages.push_back({{"name", stage.name},
                      {"seconds", stage.seconds},
                      {"busy_cpu_seconds", stage.busy_seconds},
                      {"memory_of_rank_bytes", stage.bytes},
                      {"losses", losses_json(stage.losses)}});
  return json;
}

std::string loss_columns(const Losses& losses, double of) {
  std::string text;
  for (const NamedLoss& loss : named_losses)
    text += fmt::format(" {:>12.1f}%", of > 0 ? 100 * (losses.*loss.seconds) / of : 0);
  return text;
}

std::string loss_heads() {
  std::string text;
  for (const NamedLoss& loss : named_losses) text += fmt::format(" {:>13}", loss.name);
  return text;
}

/// The smallest number of ranks that misses the wanted efficiency, where there is one: that is where to look.
const Prediction& first_inefficient(const std::vector<Prediction>& predictions) {
  const auto found = std::find_if(predictions.begin(), predictions.end(), [](const Prediction& each) {
    return each.efficiency() < wanted_efficiency;
  });
  return found == predictions.end() ? predictions.back() : *found;
}

}  // namespace

WorthwhileRanks worthwhile_ranks(const RunCosts& costs, const Network& network) {
  WorthwhileRanks worthwhile;
  worthwhile.ranks = ranks_at_efficiency(costs, network, wanted_efficiency);
  const Prediction there = predict(costs, worthwhile.ranks, network);
  worthwhile.seconds = there.seconds;
  worthwhile.bytes_per_rank = there.bytes;
  worthwhile.ranks_without_geometry =
      ranks_at_efficiency(without(costs, "geometry"), network, wanted_efficiency);
  return worthwhile;
}

Forecasts forecast_ranks(const RunCosts& costs, const std::string& record, const std::vector<int>& ranks,
                         const Network& network) {
  Forecasts forecasts{record, costs.ranks, network, {}, {}};
  for (const int each : ranks) forecasts.predictions.push_back(predict(costs, each, network));
  forecasts.worthwhile = worthwhile_ranks(costs, network);
  return forecasts;
}

Json to_json(const WorthwhileRanks& worthwhile, const Network& network) {
  return {{"ranks_at_80_percent", worthwhile.ranks},
          {"seconds_there", worthwhile.seconds},
          {"bytes_per_rank", worthwhile.bytes_per_rank},
          {"ranks_at_80_percent_without_geometry", worthwhile.ranks_without_geometry},
          {"latency_seconds", network.latency},
          {"bytes_per_second", network.bandwidth}};
}

Json prediction_json(const Forecasts& forecasts) {
  Json json{{"schema_version", prediction_version},
            {"record", forecasts.record},
            {"recorded_ranks", forecasts.recorded_ranks}};
  json.update(to_json(forecasts.worthwhile, forecasts.network));
  Json& rows = json["rows"] = Json::array();
  for (const Prediction& prediction : forecasts.predictions) rows.push_back(prediction_row(prediction));
  return json;
}

std::string prediction_csv(const Forecasts& forecasts) {
  std::string text = "ranks,stage,seconds,busy_cpu_seconds,memory_of_rank_bytes";
  for (const NamedLoss& loss : named_losses) text += fmt::format(",{}_seconds", loss.name);
  text += '\n';
  const auto add = [&](int ranks, const std::string& stage, const auto& made) {
    text +=
        fmt::format("{},{},{:.6g},{:.6g},{:.0f}", ranks, stage, made.seconds, made.busy_seconds, made.bytes);
    for (const NamedLoss& loss : named_losses) text += fmt::format(",{:.6g}", made.losses.*loss.seconds);
    text += '\n';
  };
  for (const Prediction& prediction : forecasts.predictions) {
    for (const StagePrediction& stage : prediction.stages) add(prediction.ranks, stage.name, stage);
    add(prediction.ranks, "all", prediction);
  }
  return text;
}

std::string prediction_text(const Forecasts& forecasts) {
  std::string text = fmt::format("{:>6} {:>10} {:>9} {:>10} {:>9}{}\n", "ranks", "seconds", "speed-up",
                                 "efficiency", "MiB/rank", loss_heads());
  for (const Prediction& each : forecasts.predictions)
    text += fmt::format("{:>6} {:>10.4g} {:>9.1f} {:>9.1f}% {:>9.0f}{}\n", each.ranks, each.seconds,
                        each.speedup(), 100 * each.efficiency(), each.bytes / mebibyte,
                        loss_columns(each.losses, each.seconds));
  const Prediction& shown = first_inefficient(forecasts.predictions);
  text += fmt::format("\n{:<10} {:>10} {:>29}{}   on {} ranks, parts of all {:.4g} s\n", "stage", "seconds",
                      "", loss_heads(), shown.ranks, shown.seconds);
  for (const StagePrediction& stage : shown.stages)
    text += fmt::format("{:<10} {:>10.4g} {:>29}{}\n", stage.name, stage.seconds, "",
                        loss_columns(stage.losses, shown.seconds));
  const WorthwhileRanks& best = forecasts.worthwhile;
  text += fmt::format(
      "\n80 % efficiency: {} rank(s), {:.4g} s, {:.0f} MiB on the largest; {} where geometry does not count\n"
      "network: {:.3g} s, {:.3g} bytes/s; record: {} rank(s), {}\n",
      best.ranks, best.seconds, best.bytes_per_rank / mebibyte, best.ranks_without_geometry,
      forecasts.network.latency, forecasts.network.bandwidth, forecasts.recorded_ranks, forecasts.record);
  return text;
}

}  // namespace aeroloom::study
