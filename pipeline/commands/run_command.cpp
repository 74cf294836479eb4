#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/staged_run.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

Command add_run(CLI::App& program) {
  CLI::App* app = program.add_subcommand("run", "mesh a case");
  const auto arguments = std::make_shared<CaseArguments>();
  add_case_file(*app, *arguments);
  add_overrides(*app, *arguments);
  return {app, [arguments](const parallel::Communicator& communicator, const Loudness& loudness) {
            return with_case(communicator, *arguments, loudness, [&](const Case& input) {
              return run_stages(communicator, input, "",
                                [&](RunRecord& record) { run_case(communicator, input, record); });
            });
          }};
}

}  // namespace aeroloom::pipeline
