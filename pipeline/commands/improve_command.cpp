#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/staged_run.hpp"
#include "pipeline/improve_file.hpp"

#include <memory>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

Command add_improve(CLI::App& program) {
  struct Arguments : CaseArguments {
    std::string mesh;
  };
  CLI::App* app = program.add_subcommand(
      "improve", "improve a mesh of tetrahedra from a file, its boundary kept as it is");
  const auto arguments = std::make_shared<Arguments>();
  app->add_option("mesh", arguments->mesh, "the mesh, in any format that is read (docs/formats.md)")
      ->required();
  add_overrides(*app, *arguments);
  return {app, [arguments](const parallel::Communicator& communicator, const Loudness& loudness) {
            return with_case(communicator, *arguments, loudness, [&](const Case& input) {
              return run_stages(communicator, input, arguments->mesh, [&](RunRecord& record) {
                improve_file(communicator, arguments->mesh, input, record);
              });
            });
          }};
}

}  // namespace aeroloom::pipeline
