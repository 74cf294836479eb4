/// How a command is added to the command line, and how it ends: the same for all commands.
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

/// How much is printed, as given before or after the name of the command.
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

/// A command in the command line. `run` is collective, called after the line was read; it returns the exit
/// code of the program, the same on every rank, and throws nothing.
struct Command {
  CLI::App* app = nullptr;
  std::function<int(const Invocation&)> run;
};

/// The case as it is given in the command line.
struct CaseArguments {
  std::string file;  ///< empty for commands that need no geometry
  std::vector<std::string> overrides;
};
void add_case_file(CLI::App& command, CaseArguments& arguments);
/// A file with a mesh that is read.
void add_mesh_file(CLI::App& command, const std::string& name, std::string& file);
/// `--set`.
void add_overrides(CLI::App& command, CaseArguments& arguments);

/// Reads the case, by rank 0, lets the log speak as the line or else the case asks for, and does the
/// work, which returns the exit code; a case that cannot be read is a usage error. Collective.
int with_case(const Invocation& invocation, const CaseArguments& arguments,
              const std::function<int(const cases::Case&)>& work);

/// Printed by rank 0 at once. Collective; throws CollectiveError where it cannot be.
void print(const Invocation& invocation, const std::string& text);
/// Prints the message on rank 0; the exit code. Collective.
int fail(const Invocation& invocation, report::ExitCode code, const std::string& message);

/// Does the work of a command that has no stages: the exit code for what it throws is `otherwise`, unless the
/// kind of failure demands another. Collective.
int guarded(const Invocation& invocation, report::ExitCode otherwise,
            const std::function<report::ExitCode()>& work);

}  // namespace aeroloom::pipeline
