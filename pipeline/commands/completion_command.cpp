#include "pipeline/commands/bash_completion.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

Command add_completion(CLI::App& program) {
  CLI::App* app = program.add_subcommand("completion", "print a script that completes this program's lines");
  const auto shell = std::make_shared<std::string>("bash");
  app->add_option("shell", *shell, "the shell that is to complete")
      ->required()
      ->check(CLI::IsMember({"bash"}))
      ->type_name("{bash}");
  add_help_footer(*app,
                  {{"aeroloom completion bash > aeroloom.bash",
                    "then `source aeroloom.bash`, or put it where "
                    "bash looks (docs/usage.md)"}},
                  {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::files});
  return {app, [&program](const Invocation& invocation) {
            return guarded(invocation, report::ExitCode::files, [&] {
              print(invocation, bash_completion(program, cases::case_keys()));
              return report::ExitCode::ok;
            });
          }};
}

}  // namespace aeroloom::pipeline
