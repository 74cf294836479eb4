#include "pipeline/check.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/commands/memory_option.hpp"

#include <cstdint>
#include <memory>

#include <CLI/CLI.hpp>

namespace aeroloom::pipeline {

Command add_check(CLI::App& program) {
  CLI::App* app = program.add_subcommand(
      "check", "diagnose the geometry of a case and predict its mesh, without meshing");
  struct Arguments : CaseArguments {
    std::int64_t memory = 0;  // bytes; 0: no limit
    FamilyRequest family;
  };
  const auto arguments = std::make_shared<Arguments>();
  add_case_file(*app, *arguments);
  add_overrides(*app, *arguments);
  add_memory_option(*app, arguments->memory);
  CLI::Option* levels =
      app->add_option("--levels", arguments->family.levels,
                      "forecast a family of so many meshes, the case first (docs/configuration/sizing.md)")
          ->type_name("N")
          ->check(CLI::Range(std::int64_t{1}, most_family_levels));
  app->add_option("--ratio", arguments->family.ratio,
                  "sizes of a level over those of the next, 1.5 by default; below 1: coarser levels")
      ->type_name("RATIO")
      ->needs(levels);
  add_help_footer(*app,
                  {{"aeroloom check case.yaml", "what is wrong with the CAD, what a run will cost"},
                   {"aeroloom check case.yaml --set sizing.target_tetrahedra=200000", "of another size"},
                   {"aeroloom check case.yaml --levels 3 --ratio 1.5", "a family for a grid study"}},
                  {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::cad,
                   report::ExitCode::files, report::ExitCode::resources, report::ExitCode::bug});
  return {app, [arguments](const Invocation& invocation) {
            return with_case(invocation, *arguments, [&](const cases::Case& input) {
              return within_memory(invocation, arguments->memory, [&] {
                return guarded(invocation, report::ExitCode::cad,
                               [&] { return check_case(invocation.communicator, input, arguments->family); });
              });
            });
          }};
}

}  // namespace aeroloom::pipeline
