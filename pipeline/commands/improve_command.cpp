#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/commands/memory_option.hpp"
#include "pipeline/commands/staged_run.hpp"
#include "pipeline/improve_file.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

Command add_improve(CLI::App& program) {
  struct Arguments : CaseArguments {
    std::string mesh;
    std::int64_t memory = 0;  // bytes; 0: no limit
  };
  CLI::App* app = program.add_subcommand(
      "improve", "improve a mesh of tetrahedra from a file, its boundary kept as it is");
  const auto arguments = std::make_shared<Arguments>();
  add_mesh_file(*app, "mesh", arguments->mesh);
  add_overrides(*app, *arguments);
  add_memory_option(*app, arguments->memory);
  add_help_footer(*app,
                  {{"aeroloom improve out/mesh.pvtu --set output.directory=better", "what a run has made"},
                   {"mpirun -n 2 aeroloom improve mesh.meshb --set improve.target_angle=20",
                    "another program's mesh, by two ranks"}},
                  {ExitCode::ok, ExitCode::usage, ExitCode::volume, ExitCode::quality_gate, ExitCode::files,
                   ExitCode::resources, ExitCode::bug});
  return {app, [arguments](const parallel::Communicator& communicator, const Loudness& loudness) {
            return with_case(communicator, *arguments, loudness, [&](const Case& input) {
              return within_memory(communicator, arguments->memory, [&] {
                return run_stages(communicator, input, {"", arguments->mesh}, [&](RunRecord& record) {
                  improve_file(communicator, arguments->mesh, input, record);
                });
              });
            });
          }};
}

}  // namespace aeroloom::pipeline
