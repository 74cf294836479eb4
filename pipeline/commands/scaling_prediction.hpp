/// The options `--predict` and `--measure-network` of `aeroloom scaling`.
#pragma once

#include "pipeline/report/exit_code.hpp"
#include "pipeline/study/replay.hpp"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace aeroloom::pipeline {

struct Invocation;

/// Files and figures for a prediction; empty: not given.
struct PredictionArguments {
  std::string run;       ///< the folder of a run
  std::string measured;  ///< the file for measurements of the network
  std::string network;   ///< a file with such measurements
  std::optional<double> latency, bandwidth;
};

/// Adds the options. Returns those that act as commands of their own.
std::vector<CLI::Option*> add_prediction_options(CLI::App& app, PredictionArguments& arguments);

/// The given network, or that of the file, or a typical cluster's. Throws std::invalid_argument;
/// std::runtime_error for an invalid file.
study::Network network_of(const PredictionArguments& arguments);

/// Prints where the time goes and writes prediction.json and prediction.csv beside the report of the run.
/// Without ranks: powers of two up to 10,000. Throws as read_costs() and predict().
report::ExitCode predict_run(const PredictionArguments& arguments, std::vector<int> ranks);

/// Measures the network between the ranks, prints the result and writes the file. Collective.
report::ExitCode measure_network(const Invocation& invocation, const std::string& file);

}  // namespace aeroloom::pipeline
