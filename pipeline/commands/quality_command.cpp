#include "pipeline/commands/commands.hpp"
#include "pipeline/commands/help.hpp"
#include "pipeline/quality_file.hpp"

#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace aeroloom::pipeline {

Command add_quality(CLI::App& program) {
  struct Arguments : CaseArguments {
    QualityRequest request;
  };
  CLI::App* app =
      program.add_subcommand("quality", "measure a mesh: angles, ratios, volumes, worst cells, defects");
  const auto arguments = std::make_shared<Arguments>();
  add_mesh_file(*app, "mesh", arguments->request.file);
  app->add_flag("--json", arguments->request.print_json, "print JSON (docs/quality.md)")
      ->group(option_group::output);
  app->add_option("--output", arguments->request.json_file, "write the JSON to this file")
      ->type_name(file_kind::json)
      ->group(option_group::output);
  for (const std::string_view key : cases::gate_keys) {
    app->add_option_function<std::string>(
           fmt::format("--gate.{}", key),
           [gate = arguments.get(), key](const std::string& value) {
             gate->overrides.push_back(fmt::format("improve.gate.{}={}", key, value));
           },
           fmt::format("as improve.gate.{} (docs/configuration/improve.md)", key))
        ->check(CLI::Number)
        ->type_name("LIMIT")
        ->group(option_group::limits);
  }
  add_help_footer(
      *app,
      {{"aeroloom quality out/mesh.pvtu", "angles, shapes, ratios, worst cells (docs/quality.md)"},
       {"aeroloom quality out/mesh.pvtu --gate.largest_edge_ratio=1000", "exit code 6 where one is larger"},
       {"aeroloom quality mesh.meshb --json --output quality.json", "the same for programs"}},
      {report::ExitCode::ok, report::ExitCode::usage, report::ExitCode::quality_gate, report::ExitCode::files,
       report::ExitCode::resources, report::ExitCode::bug});
  return {app, [arguments](const Invocation& invocation) {
            return with_case(invocation, *arguments, [&](const cases::Case& input) {
              std::string missed;
              const int code = guarded(invocation, report::ExitCode::files, [&] {
                const QualityRequest& request = arguments->request;
                missed = show_quality(io::read_mesh({invocation.communicator, request.file}, 0), request,
                                      input.gate);
                return report::ExitCode::ok;
              });
              if (!missed.empty()) return fail(invocation, report::ExitCode::quality_gate, missed);
              if (code == 0 && !arguments->overrides.empty() && !arguments->request.print_json)
                print(invocation, "limits: every one is met\n");
              return code;
            });
          }};
}

}  // namespace aeroloom::pipeline
