#include "pipeline/commands/scaling_prediction.hpp"

#include "geometry/sort_unique.hpp"
#include "parallel/communication/collective_error.hpp"
#include "parallel/communication/network_probe.hpp"
#include "pipeline/commands/command.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/report/text_file.hpp"
#include "pipeline/study/prediction_files.hpp"

#include <stdexcept>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace aeroloom::pipeline {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int most_ranks_shown = 10'000;

std::vector<int> usual_ranks() {
  std::vector<int> ranks;
  for (int n = 1; n < most_ranks_shown; n *= 2) ranks.push_back(n);
  ranks.push_back(most_ranks_shown);
  return ranks;
}

Json to_json(const parallel::NetworkProbe& probe, int ranks) {
  Json json{{"schema_version", 1},
            {"ranks", ranks},
            {"latency_seconds", probe.latency_seconds},
            {"bytes_per_second", probe.bytes_per_second},
            {"reduction_seconds", probe.reduction_seconds}};
  Json& messages = json["messages"] = Json::array();
  for (const parallel::MessageTiming& each : probe.messages)
    messages.push_back({{"bytes", each.bytes}, {"seconds", each.seconds}});
  return json;
}

std::string describe(const parallel::NetworkProbe& probe, int ranks, const std::string& file) {
  std::string text = fmt::format("{:>10} {:>14} {:>12}\n", "bytes", "microseconds", "MB/s");
  for (const parallel::MessageTiming& each : probe.messages)
    text += fmt::format("{:>10} {:>14.2f} {:>12.1f}\n", each.bytes, 1e6 * each.seconds,
                        1e-6 * static_cast<double>(each.bytes) / each.seconds);
  text += fmt::format("reduction over {} ranks: {:.2f} microseconds\n", ranks, 1e6 * probe.reduction_seconds);
  return text + fmt::format("--latency {:.3g} --bandwidth {:.3g}, or --network {}\n", probe.latency_seconds,
                            probe.bytes_per_second, file);
}

}  // namespace

std::vector<CLI::Option*> add_prediction_options(CLI::App& app, PredictionArguments& arguments) {
  CLI::Option* run =
      app.add_option(
             "--predict", arguments.run,
             "from what this run has left: its time and memory on other --ranks, up to 10,000, and where "
             "the time goes")
          ->type_name("DIR");
  CLI::Option* measured = app.add_option("--measure-network", arguments.measured,
                                         "under a launcher: measure between the ranks, for --network")
                              ->type_name(file_kind::json);
  CLI::Option* network =
      app.add_option("--network", arguments.network, "latency and bandwidth as measured into that file")
          ->type_name(file_kind::json);
  CLI::Option* latency =
      app.add_option("--latency", arguments.latency, "of a message, in seconds; 5e-6 by default")
          ->check(CLI::Range(0.0, 1.0))
          ->type_name("SECONDS");
  CLI::Option* bandwidth = app.add_option("--bandwidth", arguments.bandwidth,
                                          "that a rank can send with, in bytes per second; 1e9 by default")
                               ->check(CLI::Range(1.0, 1e15))
                               ->type_name("BYTES/S");
  network->excludes(latency)->excludes(bandwidth);
  measured->excludes(run);
  return {run, measured};
}

study::Network network_of(const PredictionArguments& arguments) {
  study::Network network;
  if (!arguments.network.empty()) {
    const Json json = Json::parse(report::read_text(arguments.network), nullptr, false);
    const auto at = [&](const char* key) {
      if (!json.is_object() || !json.contains(key) || !json[key].is_number())
        throw std::runtime_error(fmt::format("'{}' has no {}. Remedy: aeroloom scaling --measure-network {}",
                                             arguments.network, key, arguments.network));
      return json[key].get<double>();
    };
    return {at("latency_seconds"), at("bytes_per_second")};
  }
  if (arguments.latency) network.latency = *arguments.latency;
  if (arguments.bandwidth) network.bandwidth = *arguments.bandwidth;
  return network;
}

report::ExitCode predict_run(const PredictionArguments& arguments, std::vector<int> ranks) {
  if (ranks.empty()) ranks = usual_ranks();
  geometry::sort_unique(ranks);
  const fs::path folder = arguments.run;
  const study::Forecasts forecasts =
      study::forecast_ranks(study::read_costs(folder), arguments.run, ranks, network_of(arguments));
  report::replace_text((folder / "prediction.json").string(),
                       study::prediction_json(forecasts).dump(1) + "\n");
  report::replace_text((folder / "prediction.csv").string(), study::prediction_csv(forecasts));
  report::print_text(study::prediction_text(forecasts));
  return report::ExitCode::ok;
}

report::ExitCode measure_network(const Invocation& invocation, const std::string& file) {
  const parallel::Communicator& communicator = invocation.communicator;
  const parallel::NetworkProbe probe = parallel::probe_network(communicator);
  parallel::on_root(communicator,
                    [&] { report::write_text(file, to_json(probe, communicator.size()).dump(1) + "\n"); });
  print(invocation, describe(probe, communicator.size(), file));
  return report::ExitCode::ok;
}

}  // namespace aeroloom::pipeline
