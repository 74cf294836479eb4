#include "pipeline/command_line.hpp"

#include "pipeline/commands/commands.hpp"

#include <vector>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {
namespace {

constexpr const char* description =
    "Aeroloom: from aircraft CAD to a distributed tetrahedral mesh.\n"
    "There are no boundary layers: all elements are isotropic tetrahedra.";

constexpr const char* examples =
    "Examples:\n"
    "  aeroloom init case.yaml --geometry wing.step        a commented case to start from\n"
    "  aeroloom run configs/transport.yaml                 mesh the built-in aircraft on one rank\n"
    "  mpirun -n 8 aeroloom run case.yaml                  the same mesh, bit for bit, by eight ranks\n"
    "  aeroloom check case.yaml                            what is wrong with the CAD, what a run will cost\n"
    "  aeroloom run case.yaml --set sizing.minimum=0.02    override a key of the case\n"
    "  aeroloom improve mesh.vtu --set output.directory=better   improve another program's mesh\n"
    "  aeroloom convert out/mesh.pvtu mesh.cgns             a mesh in the format of a solver "
    "(docs/formats.md)\n"
    "  aeroloom quality mesh.meshb --gate.largest_edge_ratio=1000   how good a mesh is (docs/quality.md)\n"
    "  aeroloom export-cad configs/transport.yaml a.step   write the case's geometry as STEP\n\n"
    "Exit codes: 0 ok, 2 usage or configuration, 3 CAD, 4 surface, 5 volume, 6 quality gate,\n"
    "7 input/output, 8 resources, 70 bug.";

void add_loudness(CLI::App& app, Loudness& loudness) {
  app.add_flag("-v,--verbose", loudness.verbose, "say more");
  app.add_flag("-q,--quiet", loudness.quiet, "print errors and warnings only");
}

}  // namespace

int run_command_line(const parallel::Communicator& communicator, int argc, char** argv) {
  CLI::App program(description, "aeroloom");
  program.footer(examples);
  program.set_version_flag("--version",
                           std::string("aeroloom ") + AEROLOOM_VERSION + "\n" + AEROLOOM_LIBRARIES);
  program.require_subcommand(1);
  Loudness loudness;
  std::vector<Command> commands;
  for (const auto add :
       {add_run, add_check, add_improve, add_quality, add_convert, add_export_cad, add_init, add_schema}) {
    commands.push_back(add(program));
    add_loudness(*commands.back().app, loudness);
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = communicator.is_root() ? program.exit(error) : error.get_exit_code();
    return code == 0 ? 0 : static_cast<int>(ExitCode::usage);
  }
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.run(communicator, loudness);
  }
  return static_cast<int>(ExitCode::bug);
}

}  // namespace aeroloom::pipeline
