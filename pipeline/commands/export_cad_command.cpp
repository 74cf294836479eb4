#include "parallel/observation/log.hpp"
#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {

Command add_export_cad(CLI::App& program) {
  struct Arguments : CaseArguments {
    std::string step;
    bool domain = false;
  };
  CLI::App* app = program.add_subcommand("export-cad", "write the geometry of a case as STEP");
  const auto arguments = std::make_shared<Arguments>();
  add_case_file(*app, *arguments);
  app->add_option("file", arguments->step, "the STEP file to write")->required()->type_name(file_kind::step);
  app->add_flag("--domain", arguments->domain, "what is meshed, with the far field, for other meshers");
  add_overrides(*app, *arguments);
  add_help_footer(*app,
                  {{"aeroloom export-cad case.yaml wing.step", "the built-in aircraft, or any case's file"},
                   {"aeroloom export-cad case.yaml domain.step --domain", "with the far field around it"}},
                  {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::cad,
                   report::ExitCode::files, report::ExitCode::resources, report::ExitCode::bug});
  return {app, [arguments](const parallel::Communicator& communicator, const Loudness& loudness) {
            return with_case(communicator, *arguments, loudness, [&](const cases::Case& input) {
              return guarded(communicator, report::ExitCode::cad, [&] {
                parallel::agree(communicator, [&] {
                  const cad::ExportedShape part =
                      arguments->domain ? cad::ExportedShape::domain : cad::ExportedShape::geometry;
                  if (communicator.is_root()) cad::export_step(input.domain, part, arguments->step);
                });
                parallel::log_info(fmt::format("wrote {}", arguments->step));
                return report::ExitCode::ok;
              });
            });
          }};
}

}  // namespace aeroloom::pipeline
