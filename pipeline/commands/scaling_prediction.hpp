/// `aeroloom scaling --predict` and `--measure-network`.
#pragma once

#include "pipeline/report/exit_code.hpp"
#include "pipeline/study/replay.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace aeroloom::pipeline {

struct Invocation;

/// Files and figures that a prediction goes by. Empty: not asked for.
struct PredictionArguments {
  std::string run;       ///< the folder of a run
  std::string measured;  ///< the file that the network's measures are written to
  std::string network;   ///< the file that they are read from
  std::optional<double> latency, bandwidth;
};

/// Adds the options; returns those that stand for commands of their own.
std::vector<CLI::Option*> add_prediction_options(CLI::App& app, PredictionArguments& arguments);

/// As given, or as a file has it, or a cluster's usual one. Throws std::invalid_argument,
/// std::runtime_error for a file that is none.
study::Network network_of(const PredictionArguments& arguments);

/// Prints where time goes, writes prediction.json and prediction.csv beside the run's report. Of no ranks:
/// the powers of two up to 10,000. Throws as read_costs() and predict().
report::ExitCode predict_run(const PredictionArguments& arguments, std::vector<int> ranks);

/// Measures between the ranks, prints, and writes the file. Collective.
report::ExitCode measure_network(const Invocation& invocation, const std::string& file);

}  // namespace aeroloom::pipeline
