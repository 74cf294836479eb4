/// Common parts of all commands: their place in the command line, arguments, errors and exit codes.
#pragma once

#include "parallel/communication/communicator.hpp"
#include "parallel/observation/log.hpp"
#include "pipeline/case/case.hpp"
#include "pipeline/report/exit_code.hpp"

#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace aeroloom::pipeline {

/// How much is printed; the flags may stand before or after the command's name.
struct Loudness {
  bool verbose = false, quiet = false;
};

/// One call of the program: its ranks, and how much it is to print.
struct Invocation {
  parallel::Communicator communicator;
  Loudness loudness = {};

  /// Prints as much as the command line asks for, or else as `otherwise` says. Collective.
  void configure_log(parallel::LogLevel otherwise = parallel::LogLevel::normal) const;
};

/// A command. `run` is called after the command line was parsed. It returns the exit code, equal on every
/// rank, and throws nothing. Collective.
struct Command {
  CLI::App* app = nullptr;
  std::function<int(const Invocation&)> run;
};

/// The case file and overrides in a command line.
struct CaseArguments {
  std::string file;  ///< empty: a command without geometry
  std::vector<std::string> overrides;
};
void add_case_file(CLI::App& command, CaseArguments& arguments);
/// Adds the argument for a mesh file.
void add_mesh_file(CLI::App& command, const std::string& name, std::string& file);
/// Adds `--set`.
void add_overrides(CLI::App& command, CaseArguments& arguments);

/// Rank 0 reads the case; then `work` gets it on every rank and returns the exit code. The command line or
/// else the case sets how much is printed. An invalid case is a usage error. Collective.
int with_case(const Invocation& invocation, const CaseArguments& arguments,
              const std::function<int(const cases::Case&)>& work);

/// Rank 0 prints the text at once. Collective; throws CollectiveError if that fails.
void print(const Invocation& invocation, const std::string& text);
/// Rank 0 prints the error message. Returns the exit code. Collective.
int fail(const Invocation& invocation, report::ExitCode code, const std::string& message);

/// Runs a command without stages. Returns `otherwise` for an exception, unless its kind has its own exit
/// code. Collective.
int guarded(const Invocation& invocation, report::ExitCode otherwise,
            const std::function<report::ExitCode()>& work);

}  // namespace aeroloom::pipeline
