#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/commands/memory_option.hpp"
#include "pipeline/commands/staged_run.hpp"
#include "pipeline/run.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

namespace {

struct RunArguments : CaseArguments {
  bool resume = false, checkpoints = false;
  std::int64_t memory = 0;  // bytes; 0: no limit
};

}  // namespace

Command add_run(CLI::App& program) {
  CLI::App* app = program.add_subcommand("run", "mesh a case");
  const auto arguments = std::make_shared<RunArguments>();
  add_case_file(*app, *arguments);
  add_overrides(*app, *arguments);
  CLI::Option* resume =
      app->add_flag("--resume", arguments->resume,
                    "go on from the checkpoint of an earlier run; as output.checkpoints=resume");
  app->add_flag("--checkpoints", arguments->checkpoints,
                "keep what each stage has made for --resume; as output.checkpoints=write")
      ->excludes(resume)
      ->group(option_group::checkpoints);
  resume->group(option_group::checkpoints);
  add_memory_option(*app, arguments->memory);
  add_help_footer(
      *app,
      {{"aeroloom run case.yaml", "the mesh goes to the folder out"},
       {"mpirun -n 2 aeroloom run case.yaml", "the same mesh, bit for bit, by two ranks"},
       {"aeroloom run case.yaml --set sizing.minimum=0.2 --set output.directory=coarse",
        "override keys of the case"},
       {"aeroloom run case.yaml --max-memory 80%", "end with a message before the node runs short"},
       {"aeroloom run case.yaml --checkpoints -q", "keep what each stage has made; print no facts"},
       {"aeroloom run case.yaml --resume", "go on where an earlier run was ended"}},
      {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::cad, report::ExitCode::surface,
       report::ExitCode::volume, report::ExitCode::quality_gate, report::ExitCode::files,
       report::ExitCode::resources, report::ExitCode::bug});
  return {app, [arguments](const Invocation& invocation) {
            CaseArguments given = *arguments;
            if (arguments->resume) given.overrides.push_back("output.checkpoints=resume");
            if (arguments->checkpoints) given.overrides.push_back("output.checkpoints=write");
            return with_case(invocation, given, [&](const cases::Case& read) {
              cases::Case input = read;
              input.memory_limit = arguments->memory;
              return within_memory(invocation, arguments->memory, [&] {
                return run_stages(invocation, input, {given.file, ""}, [&](report::RunRecord& record) {
                  run_case(invocation.communicator, input, record);
                });
              });
            });
          }};
}

}  // namespace aeroloom::pipeline
