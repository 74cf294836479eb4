#include "pipeline/commands/command_line.hpp"

#include "parallel/observation/progress.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/commands/help_formatter.hpp"
#include "pipeline/commands/usage_error.hpp"
#include "pipeline/report/library_versions.hpp"

#include <memory>
#include <vector>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {
namespace {

constexpr const char* program_description =
    "Aeroloom: from aircraft CAD to a distributed tetrahedral mesh.\n"
    "Boundary layers of prisms stand on walls where the case asks for them.";

/// Before the name of the command or after it.
void add_loudness(CLI::App& app, Loudness& loudness) {
  app.add_flag("-v,--verbose", loudness.verbose, "say more")->group(option_group::printing);
  app.add_flag("-q,--quiet", loudness.quiet, "print warnings and errors only")->group(option_group::printing);
}

void describe_program(CLI::App& program) {
  program.set_help_flag("-h,--help", "print this help and exit");
  program.set_version_flag("--version", report::version_text,
                           "print the versions of the program and its libraries");
  program.require_subcommand(1);
  program.formatter(std::make_shared<HelpFormatter>());  // commands have it from here
  add_help_footer(program,
                  {{"aeroloom init case.yaml --geometry wing.step", "a commented case to start from"},
                   {"aeroloom check case.yaml", "what is wrong with the CAD, what a run will cost"},
                   {"aeroloom run case.yaml", "from CAD to a mesh, in the folder out"},
                   {"mpirun -n 2 aeroloom run case.yaml", "the same mesh, bit for bit, by two ranks"},
                   {"aeroloom quality out/mesh.pvtu", "how good it is"},
                   {"aeroloom convert out/mesh.pvtu mesh.cgns", "a mesh in the format of a solver"},
                   {"aeroloom run --help", "the options of a command, with more examples"}},
                  {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::cad,
                   report::ExitCode::surface, report::ExitCode::volume, report::ExitCode::quality_gate,
                   report::ExitCode::files, report::ExitCode::resources, report::ExitCode::bug});
}

}  // namespace

int run_command_line(const parallel::Communicator& communicator, int argc, char** argv) {
  CLI::App program(program_description, "aeroloom");
  describe_program(program);
  Invocation invocation{communicator};
  add_loudness(program, invocation.loudness);
  std::vector<Command> commands;
  for (const auto add : {add_run, add_check, add_info, add_improve, add_quality, add_convert, add_export_cad,
                         add_completion, add_init, add_schema, add_scaling}) {
    commands.push_back(add(program));
    commands.back().app->group("Commands");
    add_loudness(*commands.back().app, invocation.loudness);
  }
  invocation.configure_log();
  parallel::watch_node_memory(communicator);
  try {
    program.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return communicator.is_root() ? program.exit(asked) : 0;
  } catch (const CLI::ParseError& error) {
    return fail(invocation, report::ExitCode::usage, explain_usage_error(program, error));
  }
  if (invocation.loudness.verbose && invocation.loudness.quiet)
    return fail(invocation, report::ExitCode::usage, "--verbose and --quiet exclude each other");
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.run(invocation);
  }
  return static_cast<int>(report::ExitCode::bug);
}

}  // namespace aeroloom::pipeline
