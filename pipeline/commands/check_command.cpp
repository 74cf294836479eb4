#include "pipeline/check.hpp"
#include "pipeline/commands/commands.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

Command add_check(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "check", "diagnose the geometry of a case and predict its mesh, without meshing");
  const auto arguments = std::make_shared<CaseArguments>();
  add_case_file(*app, *arguments);
  add_overrides(*app, *arguments);
  return {app, [arguments](const parallel::Communicator& communicator, const Loudness& loudness) {
            return with_case(communicator, *arguments, loudness, [&](const Case& input) {
              return guarded(communicator, ExitCode::cad, [&] { return check_case(communicator, input); });
            });
          }};
}

}  // namespace aeroloom::pipeline
